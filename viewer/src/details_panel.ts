import { absent, html, panel } from './dom';
import type { Model } from './model';
import { saveButtons } from './save';

function table(model: Model, name: string, columns: string[], rows: string[][], label: string): HTMLElement {
  return html(
    'div',
    { class: 'saved' },
    saveButtons(model.title, name, { csv: () => [columns, ...rows] }),
    grid(columns, rows, label),
  );
}

/** A table of texts that scrolls where it is long. */
export function grid(columns: string[], rows: string[][], label: string): HTMLElement {
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
  return panel('rounds', title, table(model, 'rounds', columns, rows, title));
}

/** The value of an option as a person writes it. */
export function valueText(value: unknown): string {
  return typeof value === 'string' ? value : JSON.stringify(value) ?? '';
}

/** Every option in force. */
export function optionsPanel(model: Model): HTMLElement {
  const rows = Object.entries(model.options ?? {}).map(([name, value]) => [name, valueText(value)]);
  const title = 'Options in force';
  if (rows.length === 0) return panel('options', title, absent('None.'));
  return panel('options', title, table(model, 'options', ['option', 'value'], rows, title));
}
