// Verdicts that are probabilities: the table sorts by them, the reasons and the map tell them.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const suite = reportSuite(cityReport(scratchFolder()));

test('the table sorts by probability', async () => {
  const { page } = suite;
  const head = '.head .col-probability';
  const shown = async () => {
    // Rows come into sight with the frame after the one that scrolls.
    await page.$eval('.grid', (grid) => new Promise((done) => {
      grid.scrollTo(0, 0);
      requestAnimationFrame(() => requestAnimationFrame(done));
    }));
    const cells = await page.$$eval('.rows .col-probability', (all) => all.map((c) => c.textContent));
    return cells.slice(0, 10).map((text) => Number(text.replaceAll('−', '-')));
  };
  await page.focus('.stage');
  await page.keyboard.press('Escape');
  await page.$eval(`${head} button`, (button) => button.click());
  assert.equal(await page.$eval(head, (cell) => cell.ariaSort), 'ascending');
  const least = await shown();
  await page.$eval(`${head} button`, (button) => button.click());
  const most = await shown();
  assert.deepEqual(least, [...least].sort((a, b) => a - b));
  assert.deepEqual(most, [...most].sort((a, b) => b - a));
  assert.ok(least[0] < 0.5 && most[0] > 0.5, `${least[0]} to ${most[0]}`);
});

test('heat, which decided nothing here, has no panel', async () => {
  const names = await suite.page.$$eval('[data-panel]', (panels) => panels.map(({ id }) => id));
  assert.deepEqual(names.filter((name) => ['heat', 'spectrum', 'decay'].includes(name)), []);
});
