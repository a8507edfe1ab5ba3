import assert from 'node:assert/strict';
import test from 'node:test';
import {
  agreement,
  comparisonSource,
  differences,
  differentFirst,
  readComparison,
} from '../src/comparison';
import { tableRows } from '../src/table_rows';
import { i32, squareDocument, u8 } from './fixture';

// The first keeps, prunes and leaves open; the second prunes all.
function document(): Record<string, any> {
  const other = squareDocument();
  other.candidates.verdict = u8([1, 1, 1]);
  return { names: ['a.json', 'b.json'], reports: [squareDocument(), other] };
}

test('verdicts are counted against each other', () => {
  const comparison = readComparison(document());
  assert.deepEqual(agreement(comparison), [[0, 1, 0], [0, 1, 0], [0, 1, 0]]);
  assert.deepEqual([...differences(comparison)], [1, 0, 1]);
  assert.deepEqual([...differentFirst(comparison)], [0, 2, 1]);
});

test('the table begins with what differs and is searched in both', () => {
  const source = comparisonSource(readComparison(document()));
  const all = { text: '', groups: new Set([0, 1]), sort: source.sort, descending: source.descending };
  assert.deepEqual([...tableRows(source, all)], [0, 2, 1]);
  assert.deepEqual([...tableRows(source, { ...all, text: 'ambiguous' })], [2]);
  assert.deepEqual([...tableRows(source, { ...all, groups: new Set([0]) })], [1]);
  const cell = (key: string, k: number) => source.columns.find((c) => c.key === key)!.text(k);
  assert.deepEqual([cell('verdict-a', 0), cell('verdict-b', 0), cell('differs', 0)], ['keep', 'prune', 'differ']);
});

test('reports on different graphs are refused', () => {
  const other = document();
  other.reports[1].candidates.to = i32([3, 2, 2]);
  assert.throws(() => readComparison(other), /not on one graph/);
});

test('an accepted candidate leads to those that it contradicts', async () => {
  const { conflictsOf, contradictedBy } = await import('../src/model');
  const [model] = readComparison(document()).models;
  assert.deepEqual([0, 1, 2].map((k) => conflictsOf(model, k)), [[], [0], []]);
  assert.deepEqual([0, 1, 2].map((k) => contradictedBy(model, k)), [[1], [], []]);
});
