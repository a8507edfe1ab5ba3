import assert from 'node:assert/strict';
import test from 'node:test';
import { histogram, stacked } from '../src/histogram';

const total = (counts: number[][]) => counts.flat().reduce((sum, n) => sum + n, 0);

test('every value that is a number is counted once', () => {
  const values = [0, 1e-30, 1, 2, 3, 1000, 1e6, Infinity, NaN];
  const bins = histogram(values, [0, 0, 0, 0, 0, 1, 1, 1, 1], 2);
  assert.equal(total(bins.counts), 8);
  assert.ok(bins.log);
  assert.ok(bins.edges.every((edge, k) => k === 0 || edge > bins.edges[k - 1]));
});

test('values that lie close together, or are negative, get even bins', () => {
  assert.ok(!histogram([1, 2, 3], [0, 0, 0], 1).log);
  assert.ok(!histogram([-1, 200, 3], [0, 0, 0], 1).log);
});

test('what is far from zero is counted in the outer bins', () => {
  const bins = histogram([-1000, -60, -2, 3, 70, 5000], [0, 0, 0, 0, 0, 0], 1, 50);
  assert.equal(total(bins.counts), 6);
  assert.deepEqual([bins.edges[0], bins.edges.at(-1)], [-50, 50]);
  assert.deepEqual([bins.counts[0][0], bins.counts[0].at(-1)], [2, 2]);
});

test('no values, or all alike, have bins', () => {
  for (const values of [[], [5, 5], [Infinity], [0, 0]]) {
    const bins = histogram(values, values.map(() => 0), 1);
    assert.equal(total(bins.counts), values.length);
    assert.ok(bins.edges.every(Number.isFinite));
  }
});

test('stacks add up', () => {
  assert.deepEqual(stacked([[1, 2], [3, 4]]), [[1, 2], [4, 6]]);
});
