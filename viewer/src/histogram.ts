/** Counts of values between edges: bin k holds edges[k] <= value < edges[k + 1]. */
export interface Histogram {
  edges: number[];
  /** counts a group and bin */
  counts: number[][];
  log: boolean;
}

const BINS = 40;
/** From this ratio of the largest to the smallest value on, bins are even in the logarithm. */
const WIDE = 100;

function isDrawable(value: number): boolean {
  return Number.isFinite(value);
}

/**
 * Sorts values into bins, a row of counts for each group. Where the values span several
 * orders of magnitude the bins are even in the logarithm; what is not positive then goes to
 * the first bin, and what is infinite to the last. What is farther than `most` from zero goes to
 * the outer bins, too.
 */
export function histogram(
  values: ArrayLike<number>,
  group: ArrayLike<number>,
  groups: number,
  most = Infinity,
): Histogram {
  const finite = Array.from(values).filter(isDrawable);
  const positive = finite.filter((value) => value > 0);
  const extent = (all: number[]) =>
    all.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], [Infinity, -Infinity]);
  let [low, high] = extent(finite).map((end) => Math.max(-most, Math.min(most, end)));
  const [smallest, largest] = extent(positive);
  const log = positive.length > 1 && largest > WIDE * smallest && low >= 0;
  if (log) {
    // What is next to nothing would only push the rest together.
    low = Math.max(smallest, largest * 1e-12);
    high = largest;
  }
  if (!(high > low)) [low, high] = Number.isFinite(low) ? [low - 0.5, low + 0.5] : [0, 1];
  const position = (value: number) =>
    log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
  const edges = Array.from({ length: BINS + 1 }, (_, k) =>
    log ? low * (high / low) ** (k / BINS) : low + ((high - low) * k) / BINS,
  );
  const counts = Array.from({ length: groups }, () => new Array<number>(BINS).fill(0));
  for (let k = 0; k < values.length; ++k) {
    const value = values[k];
    if (Number.isNaN(value)) continue;
    const at = log && value <= 0 ? 0 : Math.floor(position(value) * BINS);
    ++counts[group[k]][Math.max(0, Math.min(BINS - 1, at))];
  }
  return { edges, counts, log };
}

/** Rows of counts added up from the first, so that bars drawn over each other stack. */
export function stacked(counts: number[][]): number[][] {
  let sum = counts[0].map(() => 0);
  return counts.map((row) => (sum = sum.map((below, k) => below + row[k])));
}
