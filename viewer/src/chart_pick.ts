import type { ChartSpec } from './chart_spec';

/** Where a chart draws what, in pixels of its plotting area. */
export interface Scales {
  valToPos(value: number, axis: 'x' | 'y'): number;
  posToVal(pixel: number, axis: 'x' | 'y'): number;
}

/** A point of a series, and where it is drawn. */
export interface FoundPoint {
  point: number;
  series: number;
  left: number;
  top: number;
}

const REACH = 24;

/** The first of ascending numbers that is at least `value`. */
export function firstNotBelow(xs: ArrayLike<number>, value: number): number {
  let [low, high] = [0, xs.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (xs[middle] < value) low = middle + 1;
    else high = middle;
  }
  return low;
}

// Bars stand between an abscissa and the next; the smallest that reaches the pointer is meant.
function barAt(scales: Scales, spec: ChartSpec, left: number, top: number): FoundPoint | null {
  const at = scales.posToVal(left, 'x');
  const point = firstNotBelow(spec.xs, at) - (spec.xs[firstNotBelow(spec.xs, at)] === at ? 0 : 1);
  if (point < 0 || point >= spec.xs.length) return null;
  const height = Math.max(...spec.series.map(({ values }) => values[point] ?? 0));
  return height > 0 ? { point, series: 0, left, top } : null;
}

/** The point that is nearest to a pixel, if one is within reach. */
export function nearestPoint(
  scales: Scales,
  spec: ChartSpec,
  left: number,
  top: number,
): FoundPoint | null {
  if (spec.series[0]?.kind === 'bars') return barAt(scales, spec, left, top);
  const first = firstNotBelow(spec.xs, scales.posToVal(left - REACH, 'x'));
  const last = scales.posToVal(left + REACH, 'x');
  let found: FoundPoint | null = null;
  let least = REACH * REACH;
  for (let point = first; point < spec.xs.length && spec.xs[point] <= last; ++point) {
    const x = scales.valToPos(spec.xs[point], 'x');
    for (let series = 0; series < spec.series.length; ++series) {
      const value = spec.series[series].values[point];
      if (value === null) continue;
      const y = scales.valToPos(value, 'y');
      const distance = (x - left) ** 2 + (y - top) ** 2;
      if (distance > least) continue;
      least = distance;
      found = { point, series, left: x, top: y };
    }
  }
  return found;
}
