/** What a chart shows; drawn by chart.ts on the page and by chart_svg.ts into a file. */
export interface ChartSpec {
  /** what the chart shows, for those who do not see it */
  description: string;
  x: ChartAxis;
  y: ChartAxis;
  xs: ArrayLike<number>;
  series: ChartSeries[];
  marks?: ChartMark[];
  /** what the pointer is told about a point; by default its coordinates */
  tell?: (point: number, series: number) => string;
  /** what a row of the saved table is called, as columns before the numbers */
  names?: { columns: string[]; of: (point: number) => string[] };
}

export interface ChartAxis {
  label: string;
  log?: boolean;
  /** ends of the axis; what the data needs if left out */
  range?: [number, number];
}

export interface ChartSeries {
  label: string;
  /** CSS variable */
  colour: string;
  kind: 'line' | 'points' | 'bars' | 'dotted-line';
  dash?: number[];
  values: ArrayLike<number | null>;
  /** what is saved, where that is not what is drawn */
  saved?: ArrayLike<number | null>;
}

/** A line across the chart, at one value of an axis. */
export interface ChartMark {
  axis: 'x' | 'y';
  value: number;
  label: string;
}

const MOST_DECADES = 7;

/** Every power of ten, or every second, third, ... where there are many. */
export function decades(low: number, high: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const step = Math.ceil((last - first + 1) / MOST_DECADES);
  const splits = [];
  for (let power = first; power <= last; power += step) splits.push(10 ** power);
  return splits;
}
