import uPlot from 'uplot';
import { chartCsv } from './chart_csv';
import { nearestPoint } from './chart_pick';
import { chartSvg } from './chart_svg';
import type { ChartAxis, ChartMark, ChartSeries, ChartSpec } from './chart_spec';
import { decades } from './chart_spec';
import { html } from './dom';
import { number, powerOfTen } from './format';
import { saveButtons } from './save';
import type { Store } from './store';
import { colour } from './theme';

const HEIGHT = 230;
const BAR_SHARE = 0.9;

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

/** Tells the values of the point that is nearest to the pointer, if one is near. */
function tellValues(plot: uPlot, spec: ChartSpec, tip: HTMLElement): void {
  const { left = -1, top = -1 } = plot.cursor;
  const found = left < 0 ? null : nearestPoint(plot, spec, left, top);
  tip.hidden = found === null;
  if (!found) return;
  tip.textContent = spec.tell?.(found.point, found.series) ?? coordinates(spec, found);
  const [width, over] = [plot.over.clientWidth, plot.over];
  const [x, y] = [over.offsetLeft + found.left, over.offsetTop + found.top];
  const room = over.offsetLeft + width - tip.offsetWidth;
  tip.style.transform = `translate(${Math.max(0, Math.min(x + 10, room))}px, ${y + 10}px)`;
}

function coordinates(spec: ChartSpec, { point, series }: { point: number; series: number }): string {
  const { label, values } = spec.series[series];
  return `${spec.x.label}: ${number(spec.xs[point])}\n${label}: ${number(values[point])}`;
}

function create(spec: ChartSpec, element: HTMLElement, tip: HTMLElement): uPlot {
  const [ink, faint] = [colour('--ink-soft'), colour('--line')];
  const options: uPlot.Options = {
    width: Math.max(element.clientWidth, 200),
    height: HEIGHT,
    scales: { x: scale(spec.x), y: scale(spec.y) },
    axes: [axis(spec.x, ink, faint, 44), axis(spec.y, ink, faint, 56)],
    series: [{ label: spec.x.label }, ...spec.series.map(series)],
    legend: { live: false },
    cursor: { drag: { x: false, y: false } },
    hooks: {
      draw: [(plot) => drawMarks(plot, spec.marks ?? [], ink)],
      setCursor: [(plot) => tellValues(plot, spec, tip)],
    },
  };
  const data = [spec.xs, ...spec.series.map(({ values }) => values)];
  return new uPlot(options, data as unknown as uPlot.AlignedData, element);
}

/** A chart that follows the theme and the width of the page, and can be saved. */
export class Chart {
  readonly element: HTMLElement;
  private readonly box = html('div', { class: 'chart', role: 'img' });
  private readonly tip = html('div', { class: 'tooltip', role: 'status', hidden: true });
  private plot: uPlot | null = null;
  private spec: ChartSpec | null = null;

  constructor(title: string, name: string, store: Store) {
    const what = { csv: () => chartCsv(this.spec!), svg: () => chartSvg(this.spec!) };
    this.element = html('div', { class: 'saved' }, saveButtons(title, name, what), this.box);
    store.subscribe((state, before) => {
      if (state.theme !== before.theme) this.draw();
    });
    new ResizeObserver(() => this.resize()).observe(this.box);
  }

  show(spec: ChartSpec): void {
    this.spec = spec;
    this.box.setAttribute('aria-label', spec.description);
    this.draw();
  }

  private draw(): void {
    this.plot?.destroy();
    this.plot = null;
    this.tip.hidden = true;
    if (!this.spec || this.box.clientWidth === 0) return;
    this.plot = create(this.spec, this.box, this.tip);
    this.plot.root.querySelector('.u-wrap')!.append(this.tip);
  }

  private resize(): void {
    if (this.plot) this.plot.setSize({ width: this.box.clientWidth, height: HEIGHT });
    else this.draw();
  }
}

/** A chart that shows one thing for good; `title` and `name` name the files it is saved as. */
export function chart(title: string, name: string, spec: ChartSpec, store: Store): HTMLElement {
  const drawn = new Chart(title, name, store);
  drawn.show(spec);
  return drawn.element;
}
