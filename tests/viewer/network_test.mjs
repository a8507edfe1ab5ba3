// A sensor network in the plane, with false ranges and known truth.
import { join } from 'node:path';
import { isotherm, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const folder = scratchFolder();
isotherm(folder, 'simulate', 'network', '--nodes', '120', '--anchors', '8',
  '--false-fraction', '0.1', '--seed', '2', '-o', 'ranges.csv', '--anchor-file', 'anchors.csv',
  '--ground-truth', 'truth.csv');
isotherm(folder, 'localize', 'ranges.csv', '--anchors', 'anchors.csv',
  '--ground-truth', 'truth.csv', '-o', 'positions.csv', '--report', 'report.html');
reportSuite(join(folder, 'report.html'));
