// A pose graph in the plane, with truth: everything a report can do.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import * as checks from './checks.mjs';
import { cityReport, scratchFolder } from './reports.mjs';

const path = cityReport(scratchFolder());
let browser;
let report;
before(async () => {
  browser = await startBrowser();
  report = await openReport(browser, path);
});
after(() => browser.close());

test('every panel is there', () => checks.checkPanels(report.page));
test('the map is drawn by WebGL', async () => {
  assert.equal(await report.page.$eval('.map', (map) => map.dataset.drawnBy), 'webgl');
  assert.ok((await checks.ink(report.page)) > 500);
  assert.ok((await checks.ink(report.page, 1)) > 500);
});
test('layers can be switched', () => checks.checkLayers(report.page));
test('a click shows row and reasons', () => checks.checkClick(report.page));
test('the table filters and sorts', () =>
  checks.checkTable(report.page, { keep: 150, prune: 80 }));
test('the keyboard suffices', () => checks.checkKeyboard(report.page));
test('the page fits', () => checks.checkFits(report.page));
test('nothing was asked of the network and nothing failed', () =>
  assert.deepEqual(report.problems, []));
