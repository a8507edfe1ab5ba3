// Charts, tables and maps are saved as files that other programs read.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import { cityReport, scratchFolder } from './reports.mjs';

const folder = scratchFolder();
const path = cityReport(folder, '--verdicts', 'verdicts.csv');
const saved = join(folder, 'saved');
mkdirSync(saved);
let browser;
let page;
let problems;
before(async () => {
  browser = await startBrowser();
  ({ page, problems } = await openReport(browser, path));
  const client = await page.createCDPSession();
  await client.send('Browser.setDownloadBehavior', { behavior: 'allow', downloadPath: saved });
});
after(() => browser.close());

/** Presses the button and waits for the whole file. */
async function save(selector, name) {
  const file = join(saved, name);
  const button = await page.$(selector);
  assert.ok(button, selector);
  await button.evaluate((element) => element.click());
  for (let tries = 0; tries < 100 && !existsSync(file); ++tries) {
    await new Promise((done) => setTimeout(done, 100));
  }
  return readFileSync(file);
}

const lines = (content) => content.toString().trim().split('\n');

test('the table is saved as the verdict file has it', async () => {
  const [head, ...rows] = lines(await save('#table [data-save=csv]', 'bad.g2o-table.csv'));
  assert.ok(head.startsWith('edge,from,to,line,verdict,score,threshold,stage'), head);
  const verdicts = lines(readFileSync(join(folder, 'verdicts.csv'))).slice(1);
  assert.equal(rows.length, verdicts.length);
  const short = (line, picked) => picked.map((k) => line.split(',')[k]).join();
  assert.deepEqual(
    rows.map((row) => short(row, [0, 1, 2, 4])),
    verdicts.map((row) => short(row, [0, 1, 2, 3])),
  );
});

test('only the rows that a filter leaves are saved, in their order', async () => {
  await page.type('[data-filter="text"]', 'prune');
  rmSync(join(saved, 'bad.g2o-table.csv'));
  const rows = lines(await save('#table [data-save=csv]', 'bad.g2o-table.csv')).slice(1);
  assert.ok(rows.length > 0 && rows.every((row) => row.split(',')[4] === 'prune'));
});

test('a chart is saved as numbers, a row a point', async () => {
  const [head, ...rows] = lines(await save('#residuals [data-save=csv]', 'bad.g2o-chi2_odometry.csv'));
  assert.equal(head, 'loop,loop in order of the file,keep,prune');
  assert.equal(rows.length, lines(readFileSync(join(folder, 'verdicts.csv'))).length - 1);
  assert.match(rows[0], /^\d+ – \d+,0,[\d.e+-]*,[\d.e+-]*$/);
});

for (const panel of ['scores', 'errors', 'map-after']) {
  const section = panel.startsWith('map') ? '#map [data-layout=after]' : `#${panel}`;

  test(`${panel} is saved as SVG that is drawn elsewhere`, async () => {
    const text = (await save(`${section} [data-save=svg]`, `bad.g2o-${panel}.svg`)).toString();
    const { root, error, paths, variables } = await page.evaluate((source) => {
      const parsed = new DOMParser().parseFromString(source, 'image/svg+xml');
      return {
        root: parsed.documentElement.tagName,
        error: parsed.querySelector('parsererror')?.textContent,
        paths: [...parsed.querySelectorAll('path')].map((path) => path.getAttribute('d').length),
        variables: source.includes('var(') || source.includes('NaN'),
      };
    }, text);
    assert.equal(error, undefined);
    assert.equal(root, 'svg');
    assert.equal(variables, false, 'colours and places are spelled out');
    assert.ok(paths.some((length) => length > 50));
  });

  test(`${panel} is saved as PNG`, async () => {
    const bytes = await save(`${section} [data-save=png]`, `bad.g2o-${panel}.png`);
    assert.deepEqual([...bytes.subarray(0, 4)], [0x89, 0x50, 0x4e, 0x47]);
    assert.ok(bytes.readUInt32BE(16) > 600 && bytes.length > 4000, 'it has size and content');
  });
}

test('nothing failed and nothing was asked of the network', () => assert.deepEqual(problems, []));
