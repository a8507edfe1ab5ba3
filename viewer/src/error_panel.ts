import { chart } from './chart';
import type { ChartSeries } from './chart_spec';
import { absent, html, panel } from './dom';
import { quantity } from './format';
import type { Layout, Model } from './model';
import { nodeName } from './model';
import type { Store } from './store';

const LOOKS = [
  { colour: '--prune', dash: [6, 4] },
  { colour: '--keep', dash: [] },
];

function gaps(values: Float32Array): (number | null)[] {
  return Array.from(values, (value) => (Number.isFinite(value) ? value : null));
}

// What the input says or the run found about each node, a series a column.
function columnSeries(model: Model): ChartSeries[] {
  return model.nodeColumns
    .filter(({ charted }) => charted)
    .map((column) => ({
      label: column.label,
      colour: '--series-4',
      kind: 'points',
      values: gaps(column.values),
    }));
}

function tell(model: Model, node: number): string {
  const [layouts, { unit }] = [model.layouts.filter(({ errors }) => errors), model];
  const lines = layouts.map((layout) => {
    const label = layouts.length === 1 ? 'error' : layout.key;
    return `${label}: ${quantity(layout.errors![node], unit)}`;
  });
  const columns = model.nodeColumns
    .filter(({ charted }) => charted)
    .map((column) => `${column.label}: ${quantity(column.values[node], column.unit)}`);
  return [`${model.nouns.node} ${nodeName(model, node)}`, ...lines, ...columns].join('\n');
}

/** How far every node is from where it truly is, along the path where there is one. */
export function errorPanel(model: Model, store: Store): HTMLElement {
  const known = model.layouts.filter((layout): layout is Layout & { errors: Float32Array } =>
    layout.errors !== null,
  );
  const title = model.path ? 'Trajectory error along the path' : 'Position errors';
  const columns = columnSeries(model);
  if (known.length + columns.length === 0) {
    return panel('errors', title, absent(model.truthNote));
  }
  const xs = model.path ?? Float32Array.from({ length: model.nodeCount }, (_, k) => k);
  const series = known.map((layout, k): ChartSeries => ({
    label: known.length === 1 ? 'error' : layout.key,
    ...LOOKS[known.length === 1 ? 1 : k % LOOKS.length],
    kind: model.path ? 'line' : 'points',
    values: gaps(layout.errors),
  }));
  return panel(
    'errors',
    title,
    chart(
      model.title,
      'errors',
      {
        description: `Distance of ${model.nodeCount} ${model.nouns.nodes} from the truth`,
        x: { label: model.path ? 'distance along the path, m' : `${model.nouns.node}, in order of the file` },
        y: { label: `error, ${model.unit}` },
        xs,
        series: [...series, ...columns],
        tell: (point) => tell(model, point),
        names: { columns: [model.nouns.node], of: (point) => [nodeName(model, point)] },
      },
      store,
    ),
    html('p', { class: 'note' }, model.truthNote),
  );
}
