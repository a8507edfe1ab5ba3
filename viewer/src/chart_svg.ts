import type { ChartAxis, ChartSeries, ChartSpec } from './chart_spec';
import { decades } from './chart_spec';
import { svg } from './dom';
import { number, powerOfTen, roundLength } from './format';
import { colour } from './theme';

const [WIDTH, HEIGHT] = [720, 360];
const [LEFT, RIGHT, TOP, BOTTOM] = [72, 16, 16, 72];
const TICKS = 6;
const FONT = { 'font-family': 'sans-serif', 'font-size': 12 };

/** One axis: from values to a share of its length, and the values that are marked. */
interface Scale {
  at(value: number): number;
  ticks: number[];
  text(value: number): string;
}

function extent(values: Iterable<number | null>, log: boolean): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value === null || !Number.isFinite(value) || (log && value <= 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [log ? 0.1 : 0, 1];
}

function scaleOf(axis: ChartAxis, values: Iterable<number | null>): Scale {
  let [low, high] = axis.range ?? extent(values, axis.log ?? false);
  if (low === high) [low, high] = axis.log ? [low / 2, high * 2] : [low - 0.5, high + 0.5];
  if (axis.log) {
    const at = (value: number) => Math.log(value / low) / Math.log(high / low);
    return { at, ticks: decades(low, high), text: powerOfTen };
  }
  const step = roundLength(((high - low) / TICKS) * 2);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) ticks.push(k * step);
  return { at: (value) => (value - low) / (high - low), ticks, text: number };
}

class Picture {
  private readonly x: Scale;
  private readonly y: Scale;

  constructor(private readonly spec: ChartSpec) {
    this.x = scaleOf(spec.x, Array.from(spec.xs));
    const all = spec.series.flatMap(({ values }) => Array.from(values));
    if (spec.series.some(({ kind }) => kind === 'bars')) all.push(0);
    this.y = scaleOf(spec.y, all);
  }

  draw(): SVGSVGElement {
    return svg(
      'svg',
      { xmlns: 'http://www.w3.org/2000/svg', width: WIDTH, height: HEIGHT, viewBox: `0 0 ${WIDTH} ${HEIGHT}` },
      svg('title', {}, this.spec.description),
      svg('rect', { width: WIDTH, height: HEIGHT, fill: colour('--card') }),
      ...this.grid(),
      ...this.spec.series.flatMap((series) => this.series(series)),
      ...this.marks(),
      ...this.legend(),
    );
  }

  private left(value: number): number {
    return LEFT + this.x.at(value) * (WIDTH - LEFT - RIGHT);
  }

  private top(value: number): number {
    return HEIGHT - BOTTOM - this.y.at(value) * (HEIGHT - TOP - BOTTOM);
  }

  private line(x1: number, y1: number, x2: number, y2: number, more: Record<string, string>): SVGElement {
    return svg('line', { x1, y1, x2, y2, ...more });
  }

  private text(x: number, y: number, text: string, more: Record<string, string> = {}): SVGElement {
    return svg('text', { x, y, fill: colour('--ink'), ...FONT, ...more }, text);
  }

  private grid(): SVGElement[] {
    const faint = { stroke: colour('--line') };
    const [floor, middle] = [HEIGHT - BOTTOM, { 'text-anchor': 'middle' }];
    const parts: SVGElement[] = [];
    for (const tick of this.x.ticks) {
      const x = this.left(tick);
      parts.push(this.line(x, TOP, x, floor, faint), this.text(x, floor + 16, this.x.text(tick), middle));
    }
    for (const tick of this.y.ticks) {
      const y = this.top(tick);
      parts.push(this.line(LEFT, y, WIDTH - RIGHT, y, faint));
      parts.push(this.text(LEFT - 6, y + 4, this.y.text(tick), { 'text-anchor': 'end' }));
    }
    const centre = (TOP + floor) / 2;
    parts.push(this.text((LEFT + WIDTH - RIGHT) / 2, floor + 34, this.spec.x.label, middle));
    parts.push(this.text(16, centre, this.spec.y.label, { ...middle, transform: `rotate(-90 16 ${centre})` }));
    return parts;
  }

  private points(series: ChartSeries): [number, number][][] {
    const runs: [number, number][][] = [[]];
    for (let k = 0; k < this.spec.xs.length; ++k) {
      const value = series.values[k];
      const shown = value !== null && Number.isFinite(value) && !(this.spec.y.log && value <= 0);
      if (shown) runs[runs.length - 1].push([this.left(this.spec.xs[k]), this.top(value)]);
      else if (runs[runs.length - 1].length > 0) runs.push([]);
    }
    return runs.filter((run) => run.length > 0);
  }

  private series(series: ChartSeries): SVGElement[] {
    if (series.kind === 'bars') return [this.bars(series)];
    const ink = colour(series.colour);
    const runs = this.points(series);
    const parts: SVGElement[] = [];
    if (series.kind !== 'points') {
      const d = runs.map((run) => `M${run.map(([x, y]) => `${x.toFixed(1)} ${y.toFixed(1)}`).join('L')}`);
      const dash = series.dash?.join(' ') || undefined;
      parts.push(svg('path', { d: d.join(''), fill: 'none', stroke: ink, 'stroke-width': 1.5, 'stroke-dasharray': dash }));
    }
    if (series.kind !== 'line') {
      const d = runs.flat().map(([x, y]) => `M${x.toFixed(1)} ${y.toFixed(1)}h0`);
      parts.push(svg('path', { d: d.join(''), fill: 'none', stroke: ink, 'stroke-width': 5, 'stroke-linecap': 'round' }));
    }
    return parts;
  }

  private bars(series: ChartSeries): SVGElement {
    const [floor, { xs }] = [this.top(0), this.spec];
    const parts: string[] = [];
    for (let k = 0; k + 1 < xs.length; ++k) {
      const [a, b] = [this.left(xs[k]), this.left(xs[k + 1])];
      if (!(series.values[k]! > 0)) continue;
      const top = this.top(series.values[k]!);
      parts.push(`M${a.toFixed(1)} ${floor}V${top.toFixed(1)}H${(a + 0.9 * (b - a)).toFixed(1)}V${floor}Z`);
    }
    return svg('path', { d: parts.join(''), fill: colour(series.colour) });
  }

  private marks(): SVGElement[] {
    const look = { stroke: colour('--ink'), 'stroke-dasharray': '5 4' };
    return (this.spec.marks ?? []).flatMap(({ axis, value, label }) => {
      const share = axis === 'x' ? this.x.at(value) : this.y.at(value);
      if (!(share >= 0 && share <= 1)) return [];
      if (axis === 'y') {
        const y = this.top(value);
        return [this.line(LEFT, y, WIDTH - RIGHT, y, look), this.text(LEFT + 4, y - 4, label)];
      }
      const x = this.left(value);
      const end = share > 0.7;
      const words = this.text(end ? x - 4 : x + 4, TOP + 12, label, { 'text-anchor': end ? 'end' : 'start' });
      return [this.line(x, TOP, x, HEIGHT - BOTTOM, look), words];
    });
  }

  private legend(): SVGElement[] {
    const place = (WIDTH - LEFT - RIGHT) / Math.max(this.spec.series.length, 1);
    return this.spec.series.flatMap((series, k) => {
      const [x, y] = [LEFT + k * place, HEIGHT - 14];
      const sign = { stroke: colour(series.colour), 'stroke-width': '4', 'stroke-dasharray': series.dash?.join(' ') ?? '' };
      return [this.line(x, y - 4, x + 18, y - 4, sign), this.text(x + 24, y, series.label)];
    });
  }
}

/** The chart as a picture of its own, in the colours of the page. */
export function chartSvg(spec: ChartSpec): SVGSVGElement {
  return new Picture(spec).draw();
}
