// On paper the report is light, whole and without controls.
import assert from 'node:assert/strict';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import { cityReport, scratchFolder } from './reports.mjs';

const folder = scratchFolder();
const path = cityReport(folder);
let browser;
before(async () => {
  browser = await startBrowser();
});
after(() => browser.close());

test('prints in light colours, with the first hundred rows', async () => {
  const media = [{ name: 'prefers-color-scheme', value: 'dark' }];
  const { page, problems } = await openReport(browser, path, { media });
  assert.equal(await page.$eval('html', (root) => root.dataset.theme), 'dark');
  await page.emulateMediaType('print');
  await page.evaluate(() => dispatchEvent(new Event('beforeprint')));
  assert.equal(await page.$eval('html', (root) => root.dataset.theme), 'light');
  assert.equal((await page.$$('.rows [data-candidate]')).length, 100);
  const hidden = await page.$eval('.filters', (filters) => getComputedStyle(filters).display);
  assert.equal(hidden, 'none');
  await page.evaluate(() => dispatchEvent(new Event('afterprint')));
  assert.equal(await page.$eval('html', (root) => root.dataset.theme), 'dark');
  const pdf = await page.pdf({ path: join(folder, 'report.pdf'), format: 'a4' });
  assert.ok(pdf.length > 10000);
  assert.deepEqual(problems, []);
});
