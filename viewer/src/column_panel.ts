import { chart } from './chart';
import { absent, html, panel } from './dom';
import { capital, count, quantity } from './format';
import { thinned } from './scene';
import type { Column, Model } from './model';
import { candidateName, VERDICTS, verdictOf } from './model';
import type { Store } from './store';

const WIDE = 100;
/** Points drawn at most; more would only lie over each other. */
const DRAWN = 8000;

/** The smallest positive number of the column and the largest finite one. */
function extent(values: Float32Array): [number, number] {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) {
    if (value > 0 && value < low) low = value;
    if (value < Infinity && value > high) high = value;
  }
  return [low, high];
}

/** Whether there is a picture to draw: what is the same for all, or unknown, has none. */
function varies(values: Float32Array): boolean {
  const known = values.filter((value) => !Number.isNaN(value));
  return known.some((value) => value !== known[0]);
}

function tell(model: Model, column: Column, candidate: number): string {
  const value = quantity(column.values[candidate], column.unit);
  const { edge } = model.nouns;
  return `${edge} ${candidateName(model, candidate)}: ${verdictOf(model, candidate)}\n${column.label}: ${value}`;
}

function columnChart(model: Model, store: Store, column: Column): HTMLElement {
  const { verdict, count: size } = model.candidates;
  const [low, high] = extent(column.values);
  const log = high > WIDE * low && column.values.every((value) => !(value < 0));
  const drawable = (value: number) => {
    if (!Number.isFinite(value)) return null;
    return log ? Math.max(value, low) : value;
  };
  const chosen = Array.from(thinned(size, DRAWN));
  const values = (group: number) =>
    chosen.map((k) => (verdict[k] === group ? drawable(column.values[k]) : null));
  const left =
    chosen.length < size ? ` Drawn: ${count(chosen.length)} of ${count(size)} ${model.nouns.edges}.` : '';
  const unit = column.unit === '' ? '' : `, ${column.unit}`;
  return html(
    'div',
    {},
    html('h3', {}, capital(column.label)),
    chart(
      model.title,
      column.key,
      {
        description: `${column.label} of ${count(size)} ${model.nouns.edges}`,
        x: { label: `${model.nouns.edge} in order of the file` },
        y: { label: column.label + unit, log },
        xs: chosen,
        series: VERDICTS.flatMap((name, group) =>
          verdict.includes(group)
            ? [{ label: name, colour: `--${name}`, kind: 'points', values: values(group) }]
            : [],
        ),
        tell: (point) => tell(model, column, chosen[point]),
        names: {
          columns: [model.nouns.edge],
          of: (point) => [candidateName(model, chosen[point])],
        },
      },
      store,
    ),
    html('p', { class: 'note' }, column.help + left),
  );
}

/** The numbers of every candidate, in order of the file: chi-squared, residuals. */
export function columnPanel(model: Model, store: Store): HTMLElement {
  const charted = model.candidates.columns.filter(({ charted: wanted, values }) => wanted && varies(values));
  const what = { pose_graph: 'χ²', network: 'Residuals', graph: 'Weights' }[model.kind];
  const title = `${what} per ${model.nouns.edge}`;
  if (model.candidates.count === 0 || charted.length === 0) {
    return panel('residuals', title, absent('There is nothing to tell them apart by.'));
  }
  const charts = charted.map((column) => columnChart(model, store, column));
  return panel('residuals', title, html('div', { class: 'charts' }, ...charts));
}
