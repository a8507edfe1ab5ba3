// Makes reports with the command, as a person does.
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const [command, data] = process.argv.slice(2);

/** A folder that is gone when the test process ends. */
export function scratchFolder() {
  const folder = mkdtempSync(join(tmpdir(), 'isotherm.viewer.'));
  process.on('exit', () => rmSync(folder, { recursive: true }));
  return folder;
}

/** Runs `isotherm` with the arguments, in `folder`. */
export function isotherm(folder, ...args) {
  execFileSync(command, [...args, '-q'], { cwd: folder, stdio: ['ignore', 'inherit', 'inherit'] });
}

/** The path of a real data set; ends the test as skipped where it is not there. */
export function realDataOrSkip(name) {
  const path = join(data, name);
  if (!existsSync(path)) {
    console.log(`no real data at ${path}`);
    process.exit(77);
  }
  return path;
}

/** A simulated city with false loops and known truth, pruned and explained. */
export function cityReport(folder, ...args) {
  const truth = ['--ground-truth', 'truth.g2o'];
  isotherm(folder, 'simulate', 'city', '--poses', '400', '--loops', '150', '--seed', '3',
    '-o', 'clean.g2o', ...truth);
  isotherm(folder, 'corrupt', 'clean.g2o', ...truth, '--count', '80', '--seed', '3',
    '-o', 'bad.g2o', '--labels', 'labels.csv');
  isotherm(folder, 'prune', 'bad.g2o', ...truth, '--report', 'report.html', ...args);
  return join(folder, 'report.html');
}
