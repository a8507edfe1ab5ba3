// Builds the page of a report: one HTML file without any reference to another.
// usage: node build.mjs [output file, default dist/report.html]
import { createHash } from 'node:crypto';
import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { dirname, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { build } from 'esbuild';

const root = dirname(fileURLToPath(import.meta.url));
const output = resolve(process.argv[2] ?? `${root}/dist/report.html`);

async function bundle(entry) {
  const result = await build({
    entryPoints: [entry],
    absWorkingDir: root,
    bundle: true,
    minify: true,
    write: false,
    format: 'iife',
    target: 'es2021',
    charset: 'ascii',
    legalComments: 'none',
    logLevel: 'warning',
  });
  return result.outputFiles[0].text.trim();
}

// The content security policy allows just these two texts and nothing from anywhere.
function hash(text) {
  return `'sha256-${createHash('sha256').update(text, 'utf8').digest('base64')}'`;
}

const script = (await bundle('src/main.ts')).replaceAll('</script', '<\\/script');
const style = await bundle('src/style.css');
const page = (await readFile(`${root}/src/index.html`, 'utf8'))
  .replace('__SCRIPT_HASH__', () => hash(script))
  .replace('__STYLE_HASH__', () => hash(style))
  .replace('__STYLE__', () => style)
  .replace('__SCRIPT__', () => script);
await mkdir(dirname(output), { recursive: true });
await writeFile(output, page);
