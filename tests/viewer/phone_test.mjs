// The same on a phone, in the dark.
import { test } from 'node:test';
import * as checks from './checks.mjs';
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const suite = reportSuite(cityReport(scratchFolder()), {
  width: 390,
  height: 844,
  media: [
    { name: 'prefers-color-scheme', value: 'dark' },
    { name: 'prefers-reduced-motion', value: 'reduce' },
  ],
});
test('the verdict is in sight', () => checks.checkVerdictInSight(suite.page));
