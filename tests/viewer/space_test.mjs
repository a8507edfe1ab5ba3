// A pose graph in space.
import { join } from 'node:path';
import { isotherm, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const folder = scratchFolder();
const truth = ['--ground-truth', 'truth.g2o'];
isotherm(folder, 'simulate', 'sphere', '--poses', '400', '--loops', '200', '--seed', '1',
  '-o', 'clean.g2o', ...truth);
isotherm(folder, 'corrupt', 'clean.g2o', ...truth, '--count', '60', '--seed', '1',
  '-o', 'bad.g2o', '--labels', 'labels.csv');
isotherm(folder, 'prune', 'bad.g2o', '--method', 'heat', ...truth, '--report', 'report.html');
reportSuite(join(folder, 'report.html'));
