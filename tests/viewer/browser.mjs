// Opens reports in a headless browser and watches everything that could go wrong.
import { existsSync } from 'node:fs';
import { createRequire } from 'node:module';
import { pathToFileURL } from 'node:url';

const require = createRequire(new URL('../../viewer/package.json', import.meta.url));

/** Where Debian puts Chromium; another one can be named in CHROMIUM. */
export const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** Starts a browser; without WebGL if asked for. */
export async function startBrowser({ webgl = true } = {}) {
  if (!existsSync(CHROMIUM)) throw new Error(`${CHROMIUM} is not there`);
  const { default: puppeteer } = await import(pathToFileURL(require.resolve('puppeteer-core')));
  return puppeteer.launch({
    executablePath: CHROMIUM,
    headless: true,
    args: [
      '--no-sandbox',
      '--disable-dev-shm-usage',
      '--hide-scrollbars',
      ...(webgl ? ['--enable-unsafe-swiftshader'] : ['--disable-3d-apis']),
    ],
  });
}

/**
 * A page that shows the report at `path`. `problems` gathers console errors, exceptions,
 * dialogs and requests for anything but the file itself.
 */
export async function openReport(browser, path, { width = 1280, height = 800, media = [] } = {}) {
  const page = await browser.newPage();
  await page.setViewport({ width, height });
  if (media.length > 0) await page.emulateMediaFeatures(media);
  const url = pathToFileURL(path).href;
  const problems = [];
  page.on('console', (message) => {
    if (message.type() === 'error') problems.push(`console: ${message.text()}`);
  });
  page.on('pageerror', (error) => problems.push(`exception: ${error.message}`));
  page.on('dialog', async (dialog) => {
    problems.push(`dialog: ${dialog.message()}`);
    await dialog.dismiss();
  });
  page.on('request', (request) => {
    // What is saved goes to disk through the page's own memory.
    if (request.url() !== url && !/^(data|blob):/.test(request.url())) {
      problems.push(`request: ${request.url()}`);
    }
  });
  await page.goto(url);
  await page.waitForSelector('html[data-ready="true"]', { timeout: 20000 });
  await page.waitForFunction(() =>
    [...document.querySelectorAll('.map')].every((map) => map.dataset.drawn === 'true'),
  );
  return { page, problems };
}
