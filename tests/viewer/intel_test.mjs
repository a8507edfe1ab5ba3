// Intel with 500 random false loops.
import { join } from 'node:path';
import { isotherm, realDataOrSkip, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const input = realDataOrSkip('outliers/intel_random_500.g2o.gz');
const folder = scratchFolder();
isotherm(folder, 'prune', input, '--report', 'report.html');
reportSuite(join(folder, 'report.html'));
