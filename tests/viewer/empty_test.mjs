// A run with nothing to decide: odometry alone.
import { join } from 'node:path';
import { isotherm, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const folder = scratchFolder();
isotherm(folder, 'simulate', 'city', '--poses', '50', '--loops', '0', '-o', 'chain.g2o');
isotherm(folder, 'prune', 'chain.g2o', '--report', 'report.html');
reportSuite(join(folder, 'report.html'), { empty: true });
