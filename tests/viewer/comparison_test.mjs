// Two methods on one graph, side by side.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import * as checks from './checks.mjs';
import { cityReport, isotherm, scratchFolder } from './reports.mjs';

const folder = scratchFolder();
cityReport(folder);
for (const method of ['consensus', 'cauchy']) {
  isotherm(folder, 'prune', 'bad.g2o', '--method', method, '--ground-truth', 'truth.g2o',
    '--report', `${method}.json`, '--verdicts', `${method}.csv`);
}
isotherm(folder, 'report', 'consensus.json', 'cauchy.json', '-o', 'both.html');

const verdicts = (name) =>
  readFileSync(join(folder, name), 'utf8').trim().split('\n').slice(1)
    .map((line) => line.split(',')[3]);
const [first, second] = [verdicts('consensus.csv'), verdicts('cauchy.csv')];
const different = first.filter((verdict, k) => verdict !== second[k]).length;

let browser;
before(async () => {
  browser = await startBrowser();
});
after(() => browser.close());

for (const width of [1280, 400]) {
  test(`both are there at ${width} pixels`, async () => {
    const { page, problems } = await openReport(browser, join(folder, 'both.html'), { width });
    const panels = await page.$$eval('[data-panel]', (all) => all.map((panel) => panel.id));
    assert.deepEqual(panels, ['summary', 'agreement', 'map', 'reasons', 'table', 'errors', 'options']);
    assert.equal((await page.$$('.map')).length, 2);
    const words = await page.$eval('#summary', (panel) => panel.innerText);
    assert.ok(words.includes('consensus.json') && words.includes('cauchy.json'), words);
    await checks.checkFits(page);
    assert.deepEqual(problems, []);
  });
}

test('what differs is counted, comes first and is stepped through first', async () => {
  assert.ok(different > 1, 'the two methods should differ');
  const { page } = await openReport(browser, join(folder, 'both.html'));
  const said = await page.$eval('#agreement p', (words) => words.textContent);
  assert.ok(said.startsWith(`${different} of ${first.length} loops`), said);
  const count = (key) => page.$$eval(`.rows .col-${key}`, (cells) => cells.map((c) => c.textContent));
  const differ = await count('differs');
  assert.ok(differ.slice(0, different).every((text) => text === 'differ'), differ.join());
  for (let k = 0; k < different + 1; ++k) {
    await page.keyboard.press('n');
    const [a, b] = await page.$$eval('#reasons dl .verdict', (all) => all.map((v) => v.textContent));
    assert.equal(a !== b, k < different, `step ${k}: ${a}, ${b}`);
  }
});

test('a filter leaves what differs, and switches reach both maps', async () => {
  const { page } = await openReport(browser, join(folder, 'both.html'));
  await page.click('[data-filter="agree"]');
  const rows = await page.$eval('.grid', (grid) => Number(grid.getAttribute('aria-rowcount')) - 1);
  assert.equal(rows, different);
  const before = [await checks.ink(page, 0), await checks.ink(page, 1)];
  await page.click('[data-layer="after:prune"]');
  assert.ok((await checks.ink(page, 0)) > before[0] && (await checks.ink(page, 1)) > before[1]);
  const boxes = await page.$$eval('[data-layer="after:prune"]', (all) => all.map((b) => b.checked));
  assert.deepEqual(boxes, [true, true]);
});

test('every value of the chart of both is told', async () => {
  const { page } = await openReport(browser, join(folder, 'both.html'));
  await checks.checkChartHover(page);
});
