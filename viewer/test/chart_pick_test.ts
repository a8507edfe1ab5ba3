import assert from 'node:assert/strict';
import test from 'node:test';
import { firstNotBelow, nearestPoint } from '../src/chart_pick';
import type { ChartSpec } from '../src/chart_spec';

// A pixel a unit, upwards from 100.
const scales = {
  valToPos: (value: number, axis: 'x' | 'y') => (axis === 'x' ? value : 100 - value),
  posToVal: (pixel: number, axis: 'x' | 'y') => (axis === 'x' ? pixel : 100 - pixel),
};

function spec(kind: 'points' | 'bars', values: (number | null)[][]): ChartSpec {
  const series = values.map((own) => ({ label: '', colour: '', kind, values: own }));
  return { description: '', x: { label: '' }, y: { label: '' }, xs: [0, 50, 60, 100], series };
}

test('the first that is not below', () => {
  assert.deepEqual([-1, 0, 55, 60, 200].map((v) => firstNotBelow([0, 50, 60, 100], v)), [0, 0, 2, 2, 4]);
});

test('the nearest point of all series is told', () => {
  const points = spec('points', [[10, 20, null, 90], [null, 40, 70, 80]]);
  const found = (left: number, top: number) => {
    const at = nearestPoint(scales, points, left, top);
    return at && [at.point, at.series];
  };
  assert.deepEqual(found(50, 78), [1, 0]);
  assert.deepEqual(found(52, 62), [1, 1]);
  assert.deepEqual(found(61, 31), [2, 1]);
  assert.equal(found(25, 50), null);
});

test('a bar is told anywhere above it', () => {
  const bars = spec('bars', [[3, 0, 5, 0], [1, 0, 2, 0]]);
  assert.equal(nearestPoint(scales, bars, 20, 10)?.point, 0);
  assert.equal(nearestPoint(scales, bars, 60, 10)?.point, 2);
  assert.equal(nearestPoint(scales, bars, 99, 10)?.point, 2);
  assert.equal(nearestPoint(scales, bars, 55, 10), null);
  assert.equal(nearestPoint(scales, bars, -5, 10), null);
  assert.equal(nearestPoint(scales, bars, 200, 10), null);
});
