// Runs the tests of the viewer's functions that need no browser.
// usage: node test.mjs
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readdirSync, rmSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const root = dirname(fileURLToPath(import.meta.url));
const folder = mkdtempSync(join(root, 'node_modules', '.test-'));
try {
  const names = readdirSync(`${root}/test`).filter((name) => name.endsWith('_test.ts'));
  await build({
    entryPoints: names.map((name) => `${root}/test/${name}`),
    bundle: true,
    platform: 'node',
    format: 'esm',
    outExtension: { '.js': '.mjs' },
    outdir: folder,
    logLevel: 'warning',
  });
  const files = readdirSync(folder).map((name) => join(folder, name));
  process.exitCode = spawnSync(process.execPath, ['--test', ...files], { stdio: 'inherit' }).status;
} finally {
  rmSync(folder, { recursive: true });
}
