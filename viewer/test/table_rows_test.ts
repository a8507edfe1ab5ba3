import assert from 'node:assert/strict';
import test from 'node:test';
import { tableRows, tableSource } from '../src/table_rows';
import { squareModel } from './fixture';

const model = squareModel();
const source = tableSource(model);
const all = { text: '', groups: new Set([0, 1, 2]), sort: 'edge', descending: false };
const rows = (change: object) => [...tableRows(source, { ...all, ...change })];

test('rows sort by value, what is not a number last', () => {
  assert.deepEqual(rows({}), [0, 1, 2]);
  assert.deepEqual(rows({ descending: true }), [2, 1, 0]);
  assert.deepEqual(rows({ sort: 'score' }), [0, 1, 2]);
  assert.deepEqual(rows({ sort: 'chi2', descending: true }), [1, 2, 0]);
});

test('ids sort as numbers, beyond 53 bits too', () => {
  assert.deepEqual(rows({ sort: 'to' }), [2, 0, 1]);
});

test('rows are filtered by verdict, whole ids and words', () => {
  assert.deepEqual(rows({ groups: new Set([1]) }), [1]);
  assert.deepEqual(rows({ text: '1' }), [0, 2]);
  assert.deepEqual(rows({ text: 'REFUTED' }), [1, 2]);
  assert.deepEqual(rows({ text: 'refuted prune' }), [1]);
  assert.deepEqual(rows({ text: 'nowhere' }), []);
});

test('cells are texts', () => {
  const cells = source.columns.map((column) => column.text(1));
  assert.deepEqual(cells, ['4', '2', '18446744073709551615', '9', 'prune', '100', '10', 'refuted', '1', '50']);
});

test('what is saved has all digits, and words for what is no number', () => {
  const [score] = source.columns.filter(({ key }) => key === 'score');
  assert.deepEqual([0, 1, 2].map((k) => score.saved(k)), ['1', '100', 'nan']);
});
