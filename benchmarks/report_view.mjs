// Measures how long a report takes until its maps are drawn and until all of it is there.
// usage: node benchmarks/report_view.mjs REPORT [TIMES]
import { pathToFileURL } from 'node:url';
import { startBrowser } from '../tests/viewer/browser.mjs';

const [path, times] = process.argv.slice(2);

/** Milliseconds from navigation to the first view and to the complete page. */
async function open(browser) {
  const page = await browser.newPage();
  await page.setViewport({ width: 1280, height: 800 });
  const start = performance.now();
  await page.goto(pathToFileURL(path).href, { waitUntil: 'domcontentloaded' });
  await page.waitForFunction(
    () => {
      const maps = [...document.querySelectorAll('.map')];
      return maps.length > 0 && maps.every((map) => map.dataset.drawn === 'true');
    },
    { polling: 10 },
  );
  const view = performance.now() - start;
  await page.waitForSelector('html[data-ready="true"]');
  const ready = performance.now() - start;
  await page.close();
  return { view, ready };
}

const browser = await startBrowser();
const runs = [];
for (let k = 0; k < Number(times ?? 5); ++k) runs.push(await open(browser));
await browser.close();
for (const what of ['view', 'ready']) {
  const sorted = runs.map((run) => run[what]).sort((a, b) => a - b);
  const seconds = sorted.map((ms) => (ms / 1000).toFixed(2));
  console.log(`${what}: ${seconds.join(' ')} s, median ${seconds[seconds.length >> 1]} s`);
}
