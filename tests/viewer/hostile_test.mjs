// Names and numbers chosen to do harm are shown, and nothing runs.
import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { openReport, startBrowser } from './browser.mjs';
import { isotherm, scratchFolder } from './reports.mjs';

const NAME = '<img src=x onerror=alert(1)>.g2o';
const MESSAGE = '</script><script>alert(2)</script><!--<script>';
const FIRST = 2n ** 63n;
const folder = scratchFolder();

// Five poses numbered from 2^63, with a loop that is right and one that is far off.
function poseGraph() {
  const name = (k) => String(FIRST + BigInt(k));
  const edge = (from, to, pose) =>
    `EDGE_SE2 ${name(from)} ${name(to)} ${pose} 100 0 0 100 0 100\n`;
  let text = '';
  for (let k = 0; k < 5; ++k) text += `VERTEX_SE2 ${name(k)} ${k} 0 0\n`;
  for (let k = 0; k < 4; ++k) text += edge(k, k + 1, '1 0 0');
  return text + edge(0, 4, '4 0 0') + edge(0, 3, '-9 5 1');
}

writeFileSync(join(folder, NAME), poseGraph());
isotherm(folder, 'prune', NAME, '--method', 'chi2', '--report', 'saved.json');

// A document from elsewhere can say anything anywhere.
const document = JSON.parse(readFileSync(join(folder, 'saved.json'), 'utf8'));
const hostile = structuredClone(document);
hostile.warnings = [MESSAGE];
hostile.notes = [MESSAGE];
hostile.truth_note = MESSAGE;
hostile.nouns.edge = MESSAGE;
hostile.nouns.trusted = MESSAGE;
hostile.candidates.stages = hostile.candidates.stages.map(() => MESSAGE);
hostile.candidates.columns[0].label = MESSAGE;
hostile.layouts[0].label = MESSAGE;
hostile.options = { [MESSAGE]: MESSAGE };
hostile.rounds = { columns: [MESSAGE], rows: [[MESSAGE]] };
writeFileSync(join(folder, 'hostile.json'), JSON.stringify(hostile));
isotherm(folder, 'report', 'hostile.json', '-o', 'hostile.html');
isotherm(folder, 'report', 'saved.json', '-o', 'named.html');
// The command makes no page of a damaged document; a page may be damaged later.
const page = readFileSync(join(folder, 'named.html'), 'utf8');
const from = `"from":{"i32":"${document.candidates.from.i32}"}`;
assert.ok(page.includes(from));
writeFileSync(join(folder, 'damaged.html'), page.replace(from, '"from":{"i32":"AQAAAP///38="}'));

let browser;
before(async () => {
  browser = await startBrowser();
});
after(() => browser.close());

test('the name of a file is text', async () => {
  const { page, problems } = await openReport(browser, join(folder, 'named.html'));
  assert.equal(await page.$eval('h1', (title) => title.textContent), NAME);
  assert.equal((await page.$$('img, main script')).length, 0);
  assert.deepEqual(problems, []);
});

test('numbers beyond 2^63 are exact', async () => {
  const { page } = await openReport(browser, join(folder, 'named.html'));
  const row = await page.$eval('.rows [data-candidate]', (element) => element.textContent);
  assert.ok(row.includes(String(FIRST)) && row.includes(String(FIRST + 4n)), row);
  await page.click('.rows [data-candidate]');
  const reasons = await page.$eval('#reasons dl', (element) => element.textContent);
  assert.ok(reasons.includes(`${FIRST} – ${FIRST + 4n}`), reasons);
});

test('messages cannot end the data or run', async () => {
  const { page, problems } = await openReport(browser, join(folder, 'hostile.html'));
  await page.click('.rows [data-candidate]');
  const text = await page.$eval('body', (body) => body.innerText);
  assert.ok(text.includes(MESSAGE));
  assert.equal((await page.$$('main script')).length, 0);
  assert.deepEqual(problems, []);
});

test('a damaged document is refused in words', async () => {
  const { page, problems } = await openReport(browser, join(folder, 'damaged.html'));
  const text = await page.$eval('main', (main) => main.innerText);
  assert.match(text, /cannot be shown: an edge ends at a node that is not there/);
  assert.deepEqual(problems, []);
});
