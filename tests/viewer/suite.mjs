// The same look at every report: opens it and checks all that it must show and do.
import assert from 'node:assert/strict';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import * as checks from './checks.mjs';

/**
 * Declares the tests of the report at `path`, with candidates to choose unless `empty`; gives
 * back what holds its page once tests run.
 */
export function reportSuite(path, { empty = false, webgl = true, ...view } = {}) {
  const suite = {};
  let browser;
  before(async () => {
    browser = await startBrowser({ webgl });
    Object.assign(suite, await openReport(browser, path, view));
  });
  after(() => browser.close());

  test('every panel is there', () => checks.checkPanels(suite.page));
  test('the map is drawn', async () => {
    const drawnBy = await suite.page.$eval('.map', (map) => map.dataset.drawnBy);
    assert.equal(drawnBy, webgl ? 'webgl' : 'svg');
    assert.ok((await checks.ink(suite.page)) > 0);
  });
  if (!empty) {
    test('N and P step through', () => checks.checkSteps(suite.page));
    test('layers can be switched', () => checks.checkLayers(suite.page));
    test('the pointer is told values on the map', () => checks.checkHover(suite.page));
    test('and on every chart', () => checks.checkChartHover(suite.page));
    test('a click shows row and reasons', () => checks.checkClick(suite.page));
    test('the table filters and sorts', () => checks.checkTable(suite.page));
    test('the keyboard suffices', () => checks.checkKeyboard(suite.page));
  }
  test('the page fits', () => checks.checkFits(suite.page));
  test('nothing failed and nothing was asked of the network', () =>
    assert.deepEqual(suite.problems, []));
  return suite;
}
