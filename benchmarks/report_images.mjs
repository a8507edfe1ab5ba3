// Pictures of reports: their tops, for the documentation, and whole pages, to look at.
// usage: node benchmarks/report_images.mjs REPORTS PICTURES NAME ...
// REPORTS has NAME.html, and gets NAME-WIDTH.png of the whole page; PICTURES gets
// report-NAME-WIDTH.png of its top, or as wide as a phone of its maps. The first pruned
// candidate is chosen.
import { join } from 'node:path';
import { openReport, startBrowser } from '../tests/viewer/browser.mjs';

const [reports, pictures, ...names] = process.argv.slice(2);
const LOOKS = [
  { width: 1280, height: 960, from: 'header' },
  { width: 400, height: 844, from: '#map' },
];

async function choosePruned(page, from) {
  await page.type('[data-filter="text"]', 'prune');
  const row = await page.$('.rows [data-candidate]');
  await row?.evaluate((element) => element.click());
  await page.evaluate((selector) => {
    document.activeElement?.blur();
    const { top } = document.querySelector(selector).getBoundingClientRect();
    window.scrollTo(0, Math.max(0, window.scrollY + top - 10));
  }, from);
}

const browser = await startBrowser();
for (const name of names) {
  for (const look of LOOKS) {
    const { page } = await openReport(browser, join(reports, `${name}.html`), look);
    await choosePruned(page, look.from);
    await page.screenshot({ path: join(pictures, `report-${name}-${look.width}.png`) });
    await page.screenshot({ path: join(reports, `${name}-${look.width}.png`), fullPage: true });
    await page.close();
  }
}
await browser.close();
