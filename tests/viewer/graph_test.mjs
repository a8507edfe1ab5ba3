// A plain graph: a ring of friends with a few chords that do not belong.
import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { test } from 'node:test';
import { isotherm, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const VERTICES = 120;
const folder = scratchFolder();
const edges = [];
for (let k = 0; k < VERTICES; ++k) {
  for (const step of [1, 2, 3]) edges.push([k, (k + step) % VERTICES]);
}
for (let k = 0; k < 12; ++k) edges.push([7 * k, (7 * k + 55) % VERTICES]);
writeFileSync(join(folder, 'ring.csv'), edges.map((ends) => `${ends.join(',')}\n`).join(''));
isotherm(folder, 'edges', 'ring.csv', '--report', 'report.html');
const suite = reportSuite(join(folder, 'report.html'));
test('heat decided, and shows how', async () => {
  for (const name of ['heat', 'spectrum', 'decay']) assert.ok(await suite.page.$(`#${name}`), name);
});
test('weights that are all the same are no chart', async () => {
  assert.equal(await suite.page.$('#residuals'), null);
});
