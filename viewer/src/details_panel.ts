import { absent, html, panel } from './dom';
import type { Model } from './model';

function table(columns: string[], rows: string[][], label: string): HTMLElement {
  return html(
    'div',
    { class: 'scroll', tabindex: 0, role: 'region', 'aria-label': label },
    html(
      'table',
      {},
      html('thead', {}, html('tr', {}, ...columns.map((c) => html('th', { scope: 'col' }, c)))),
      html(
        'tbody',
        {},
        ...rows.map((row) => html('tr', {}, ...row.map((cell) => html('td', {}, cell)))),
      ),
    ),
  );
}

/** What happened round by round. */
export function roundsPanel(model: Model): HTMLElement {
  const { columns, rows } = model.rounds;
  const title = 'Rounds';
  if (rows.length === 0) return panel('rounds', title, absent('This run has no table of rounds.'));
  return panel('rounds', title, table(columns, rows, title));
}

/** Every option in force. */
export function optionsPanel(model: Model): HTMLElement {
  const rows = Object.entries(model.options ?? {}).map(([name, value]) => [
    name,
    typeof value === 'string' ? value : JSON.stringify(value),
  ]);
  const title = 'Options in force';
  if (rows.length === 0) return panel('options', title, absent('None.'));
  return panel('options', title, table(['option', 'value'], rows, title));
}
