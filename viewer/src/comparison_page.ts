import { chart } from './chart';
import type { Comparison } from './comparison';
import { agreement, comparisonSource, differences } from './comparison';
import { grid, valueText } from './details_panel';
import { absent, html, panel } from './dom';
import { capital, count, quantity } from './format';
import { mapPanel } from './map_panel';
import type { Layout, Model } from './model';
import { nodeName, VERDICTS } from './model';
import { reasonsBody } from './reasons_panel';
import { saveButtons } from './save';
import type { Store } from './store';
import { summaryBody } from './summary_panel';
import { tablePanel } from './table_panel';

const SIDES = ['A', 'B'];

/** Two elements side by side, under the names of the reports. */
function pair(names: string[], contents: (side: number) => (Node | string)[]): HTMLElement {
  const halves = names.map((name, side) =>
    html('div', { 'data-side': SIDES[side].toLowerCase() }, html('h3', {}, `${SIDES[side]}: ${name}`), ...contents(side)),
  );
  return html('div', { class: 'pair' }, ...halves);
}

/** What both say about themselves. */
export function summariesPanel({ names, models }: Comparison): HTMLElement {
  return panel('summary', 'Summary', pair(names, (side) => summaryBody(models[side])));
}

/** How often the two decided alike, and how otherwise. */
export function agreementPanel(comparison: Comparison): HTMLElement {
  const { names, models } = comparison;
  const { edges } = models[0].nouns;
  const differ = differences(comparison).reduce((sum, value) => sum + value, 0);
  const columns = ['', ...VERDICTS.map((verdict) => `B: ${verdict}`)];
  const rows = agreement(comparison).map((row, k) => [`A: ${VERDICTS[k]}`, ...row.map(count)]);
  const words =
    differ === 0
      ? `Both decided alike on all ${count(models[0].candidates.count)} ${edges}.`
      : `${count(differ)} of ${count(models[0].candidates.count)} ${edges} have different verdicts. ` +
        'They come first in the table, and N and P step through them first.';
  const title = `${models[0].title}-${names.join('-')}`;
  return panel(
    'agreement',
    'Where verdicts differ',
    html('p', {}, words),
    html(
      'div',
      { class: 'saved' },
      saveButtons(title, 'agreement', { csv: () => [columns, ...rows] }),
      grid(columns, rows, 'Verdicts of A and B'),
    ),
  );
}

function result(model: Model): Layout {
  return model.layouts[model.layouts.length - 1];
}

/** What both made of the graph, side by side. */
export function resultsPanel(
  { names, models }: Comparison,
  store: Store,
): { element: HTMLElement; drawn: Promise<unknown> } {
  const shown = models.map((model, side) => {
    const layout = result(model);
    return { model, layout: { ...layout, label: `${SIDES[side]}: ${names[side]}. ${layout.label}` } };
  });
  return mapPanel(shown, store);
}

/** Why each of the two decided about the chosen candidate as it did. */
export function bothReasonsPanel({ names, models }: Comparison, store: Store): HTMLElement {
  const { edge } = models[0].nouns;
  return panel('reasons', `Why this ${edge}?`, pair(names, (side) => [reasonsBody(models[side], store)]));
}

export function differencesPanel(comparison: Comparison, store: Store): HTMLElement {
  return tablePanel(comparisonSource(comparison), store);
}

/** How far the nodes of both are from where they truly are, where truth was given. */
export function bothErrorsPanel({ names, models }: Comparison, store: Store): HTMLElement {
  const [{ nouns, unit, nodeCount, title }] = models;
  const heading = `${capital(nouns.node)} errors`;
  const errors = models.map((model) => result(model).errors);
  if (errors.some((values) => values === null)) {
    return panel('errors', heading, absent('Not both have ground truth.'));
  }
  const known = (values: Float32Array) =>
    Array.from(values, (value) => (Number.isFinite(value) ? value : null));
  const tell = (node: number) =>
    [
      `${nouns.node} ${nodeName(models[0], node)}`,
      ...names.map((name, side) => `${SIDES[side]}, ${name}: ${quantity(errors[side]![node], unit)}`),
    ].join('\n');
  return panel(
    'errors',
    heading,
    chart(
      `${title}-${names.join('-')}`,
      'errors',
      {
        description: `Distance of ${count(nodeCount)} ${nouns.nodes} from the truth, in both reports`,
        x: { label: `${nouns.node}, in order of the file` },
        y: { label: `error, ${unit}` },
        xs: Float32Array.from({ length: nodeCount }, (_, k) => k),
        series: names.map((name, side) => ({
          label: `${SIDES[side]}: ${name}`,
          colour: `--series-${side + 1}`,
          kind: 'line',
          dash: side === 1 ? [6, 4] : [],
          values: known(errors[side]!),
        })),
        tell,
        names: { columns: [nouns.node], of: (node) => [nodeName(models[0], node)] },
      },
      store,
    ),
    html('p', { class: 'note' }, models[0].truthNote),
  );
}

/** The options in which the two differ. */
export function changedOptionsPanel({ names, models }: Comparison): HTMLElement {
  const [a, b] = models.map(({ options }) => options ?? {});
  const text = (options: Record<string, unknown>, key: string) =>
    key in options ? valueText(options[key]) : '–';
  const rows = [...new Set([...Object.keys(a), ...Object.keys(b)])]
    .map((key) => [key, text(a, key), text(b, key)])
    .filter(([, x, y]) => x !== y);
  const title = 'Options that differ';
  if (rows.length === 0) return panel('options', title, absent('None.'));
  return panel('options', title, grid(['option', ...names.map((name, k) => `${SIDES[k]}: ${name}`)], rows, title));
}
