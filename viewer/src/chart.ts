import uPlot from 'uplot';
import { html } from './dom';
import { number, powerOfTen } from './format';
import type { Store } from './store';
import { colour } from './theme';

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
}

/** A line across the chart, at one value of an axis. */
export interface ChartMark {
  axis: 'x' | 'y';
  value: number;
  label: string;
}

export interface ChartSpec {
  /** what the chart shows, for those who do not see it */
  description: string;
  x: ChartAxis;
  y: ChartAxis;
  xs: ArrayLike<number>;
  series: ChartSeries[];
  marks?: ChartMark[];
}

const HEIGHT = 230;
const MOST_DECADES = 7;
const BAR_SHARE = 0.9;

// Every power of ten, or every second, third, ... where there are many.
function decades(low: number, high: number): number[] {
  const [first, last] = [Math.ceil(Math.log10(low) - 1e-9), Math.floor(Math.log10(high) + 1e-9)];
  const step = Math.ceil((last - first + 1) / MOST_DECADES);
  const splits = [];
  for (let power = first; power <= last; power += step) splits.push(10 ** power);
  return splits;
}

function axis(spec: ChartAxis, ink: string, faint: string, size: number): uPlot.Axis {
  return {
    label: spec.label,
    labelSize: 22,
    labelFont: '12px system-ui, sans-serif',
    font: '11px system-ui, sans-serif',
    size,
    stroke: ink,
    grid: { stroke: faint, width: 1 },
    ticks: { stroke: faint, width: 1 },
    values: (_, splits) => splits.map(spec.log ? powerOfTen : number),
    ...(spec.log
      ? { splits: (_, __, low, high) => decades(low, high), filter: (_, splits) => splits }
      : {}),
  };
}

function scale(spec: ChartAxis): uPlot.Scale {
  const range = spec.range;
  return {
    time: false,
    ...(spec.log ? { distr: 3 as const, log: 10 as const } : {}),
    ...(range ? { range: () => range } : {}),
  };
}

function series(spec: ChartSeries): uPlot.Series {
  const stroke = colour(spec.colour);
  const common = { label: spec.label, stroke };
  switch (spec.kind) {
    case 'points':
      return { ...common, paths: () => null, points: { show: true, size: 5, fill: stroke, width: 0 } };
    case 'bars':
      return {
        ...common,
        fill: stroke,
        width: 0,
        points: { show: false },
        paths: uPlot.paths.bars!({ size: [BAR_SHARE, Infinity], align: 1 }),
      };
    default:
      return {
        ...common,
        width: 2,
        ...(spec.dash ? { dash: spec.dash } : {}),
        points: { show: spec.kind === 'dotted-line', size: 6, fill: stroke },
      };
  }
}

function drawMarks(plot: uPlot, marks: ChartMark[], ink: string): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.strokeStyle = ink;
  ctx.fillStyle = ink;
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([5 * devicePixelRatio, 4 * devicePixelRatio]);
  ctx.textAlign = 'left';
  ctx.textBaseline = 'alphabetic';
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  for (const mark of marks) {
    const at = plot.valToPos(mark.value, mark.axis, true);
    const [low, size] = mark.axis === 'x' ? [bbox.left, bbox.width] : [bbox.top, bbox.height];
    if (!(at >= low && at <= low + size)) continue;
    ctx.beginPath();
    if (mark.axis === 'x') {
      ctx.moveTo(at, bbox.top);
      ctx.lineTo(at, bbox.top + bbox.height);
    } else {
      ctx.moveTo(bbox.left, at);
      ctx.lineTo(bbox.left + bbox.width, at);
    }
    ctx.stroke();
    const gap = 4 * devicePixelRatio;
    const wide = ctx.measureText(mark.label).width;
    const fits = at + gap + wide < bbox.left + bbox.width;
    const x = mark.axis === 'x' ? (fits ? at + gap : at - gap - wide) : bbox.left + gap;
    const y = mark.axis === 'x' ? bbox.top + 12 * devicePixelRatio : at - gap;
    ctx.fillText(mark.label, x, y);
  }
  ctx.restore();
}

function create(spec: ChartSpec, element: HTMLElement): uPlot {
  const [ink, faint] = [colour('--ink-soft'), colour('--line')];
  const options: uPlot.Options = {
    width: Math.max(element.clientWidth, 200),
    height: HEIGHT,
    scales: { x: scale(spec.x), y: scale(spec.y) },
    axes: [axis(spec.x, ink, faint, 44), axis(spec.y, ink, faint, 56)],
    series: [{ label: spec.x.label }, ...spec.series.map(series)],
    legend: { live: false },
    cursor: { drag: { x: false, y: false } },
    hooks: { draw: [(plot) => drawMarks(plot, spec.marks ?? [], ink)] },
  };
  const data = [spec.xs, ...spec.series.map(({ values }) => values)];
  return new uPlot(options, data as unknown as uPlot.AlignedData, element);
}

/** A chart that follows the theme and the width of the page. */
export class Chart {
  readonly element = html('div', { class: 'chart', role: 'img' });
  private plot: uPlot | null = null;
  private spec: ChartSpec | null = null;

  constructor(store: Store) {
    store.subscribe((state, before) => {
      if (state.theme !== before.theme) this.draw();
    });
    new ResizeObserver(() => this.resize()).observe(this.element);
  }

  show(spec: ChartSpec): void {
    this.spec = spec;
    this.element.setAttribute('aria-label', spec.description);
    this.draw();
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = null;
    if (this.spec && this.element.clientWidth > 0) this.plot = create(this.spec, this.element);
  }

  private resize(): void {
    if (this.plot) this.plot.setSize({ width: this.element.clientWidth, height: HEIGHT });
    else this.draw();
  }
}

/** A chart that shows one thing for good. */
export function chart(spec: ChartSpec, store: Store): HTMLElement {
  const drawn = new Chart(store);
  drawn.show(spec);
  return drawn.element;
}
