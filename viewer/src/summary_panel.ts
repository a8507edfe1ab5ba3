import { html, panel } from './dom';
import type { Model } from './model';

/** What happened, in words. */
export function summaryPanel(model: Model): HTMLElement {
  return panel('summary', 'Summary', ...summaryBody(model));
}

/** The words and what was noticed on the way. */
export function summaryBody(model: Model): HTMLElement[] {
  const entries = model.summary.flatMap(({ heading, text }) => [
    html('dt', {}, heading),
    html('dd', {}, text),
  ]);
  const asides = [
    ...model.warnings.map((text) => html('li', { class: 'warning' }, `Warning: ${text}`)),
    ...model.notes.map((text) => html('li', {}, text)),
  ];
  return [
    html('dl', { class: 'words' }, ...entries),
    ...(asides.length > 0 ? [html('ul', { class: 'asides' }, ...asides)] : []),
  ];
}
