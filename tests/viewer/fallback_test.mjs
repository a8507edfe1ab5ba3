// Without WebGL the map is SVG and does all the same.
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

reportSuite(cityReport(scratchFolder()), { webgl: false });
