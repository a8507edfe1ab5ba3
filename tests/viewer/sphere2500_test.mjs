// Sphere2500 with 490 random false loops, pruned by heat, the faster method there.
import { join } from 'node:path';
import { isotherm, realDataOrSkip, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const input = realDataOrSkip('outliers/sphere2500_random_490.g2o.gz');
const folder = scratchFolder();
isotherm(folder, 'prune', input, '--method', 'heat', '--report', 'report.html');
reportSuite(join(folder, 'report.html'));
