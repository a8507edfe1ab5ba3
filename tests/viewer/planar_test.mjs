// A pose graph in the plane, with truth.
import { test } from 'node:test';
import * as checks from './checks.mjs';
import { cityReport, scratchFolder } from './reports.mjs';
import { reportSuite } from './suite.mjs';

const suite = reportSuite(cityReport(scratchFolder()));
test('loops in conflict lead to each other', () => checks.checkConflictLinks(suite.page));
test('pruned loops come back to the result when asked for', () =>
  checks.checkPrunedSwitch(suite.page));
