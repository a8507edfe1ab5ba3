// A pose graph in the plane, with truth.
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

reportSuite(cityReport(scratchFolder()));
