// The committed page is what the sources build.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { fileURLToPath } from 'node:url';

const viewer = fileURLToPath(new URL('../../viewer/', import.meta.url));

test('viewer/dist/report.html is what viewer/src builds', () => {
  const folder = mkdtempSync(join(tmpdir(), 'isotherm.template.'));
  try {
    const rebuilt = join(folder, 'report.html');
    execFileSync(process.execPath, [`${viewer}build.mjs`, rebuilt]);
    const same = readFileSync(rebuilt).equals(readFileSync(`${viewer}dist/report.html`));
    assert.ok(same, 'stale: run "npm ci && npm run build" in viewer/ and commit dist/report.html');
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test('the page refers to nothing outside itself', () => {
  const page = readFileSync(`${viewer}dist/report.html`, 'utf8');
  assert.match(page, /default-src 'none'/);
  assert.doesNotMatch(page, /<(script|img|link|iframe)[^>]+(src|href)=["']?(?!data:)[a-z/]/i);
  assert.equal(page.split('__ISOTHERM_REPORT__').length, 2);
});
