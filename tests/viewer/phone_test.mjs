// The same on a phone, in the dark.
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

reportSuite(cityReport(scratchFolder()), {
  width: 390,
  height: 844,
  media: [
    { name: 'prefers-color-scheme', value: 'dark' },
    { name: 'prefers-reduced-motion', value: 'reduce' },
  ],
});
