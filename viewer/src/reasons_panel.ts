import { absent, html, panel } from './dom';
import { aOrAn, capital, count, number, quantity } from './format';
import type { Model } from './model';
import { candidateName, conflictsOf, contradictedBy, stageOf, verdictOf } from './model';
import type { Store } from './store';

const SHOWN_CONFLICTS = 40;

/** What a stage means, where its name does not say it. */
export function stageInWords(stage: string): string {
  if (/^t=/.test(stage)) return `at diffusion time ${stage.replace('=', ' = ')}`;
  const words: Record<string, string> = {
    accepted: 'accepted: part of the best explanation of all measurements',
    rejected: 'rejected: all measurements are explained better without it',
    unconnected: 'unconnected: nothing accepted joins its ends',
    induction: 'at induction: its weight vanished',
    correct: 'as long as the other ranges have it',
    'too long': 'too long, as the other ranges have it',
    false: 'false: the other ranges have another length',
    bridge: 'bridge: the rest of the graph says nothing about it',
    'self-loop': 'it joins a vertex with itself',
    'no-odometry-path': 'no odometry joins its ends',
    'short-path': 'the paths at its ends are too short to compare',
  };
  return words[stage] ?? stage;
}

function comparison(score: number, threshold: number): string {
  if (!(threshold > 0) || !Number.isFinite(threshold)) {
    return `${number(score)} (no threshold applied)`;
  }
  const ratio = score >= 0 ? ` (${number(score / threshold)} times)` : '';
  return `${number(score)} against a threshold of ${number(threshold)}${ratio}`;
}

// Links from loop to loop.
function linksTo(model: Model, store: Store, others: number[]): Node {
  if (!model.candidates.conflicts) return html('span', {}, 'not told by this method');
  if (others.length === 0) return html('span', {}, 'none');
  const buttons = others.slice(0, SHOWN_CONFLICTS).map((other) => {
    const button = html(
      'button',
      { type: 'button', class: 'link', 'data-candidate': other },
      candidateName(model, other),
    );
    button.addEventListener('click', () => store.select(other));
    return button;
  });
  const more = others.length - buttons.length;
  return html('span', { class: 'chips' }, ...buttons, more > 0 ? `and ${count(more)} more` : '');
}

// An accepted candidate leads to those that it speaks against.
function contradicted(model: Model, store: Store, candidate: number): [string, Node][] {
  const others = contradictedBy(model, candidate);
  return others.length > 0 ? [['Contradicts', linksTo(model, store, others)]] : [];
}

function reasons(model: Model, store: Store, candidate: number): HTMLElement {
  const { candidates, nouns } = model;
  const verdict = verdictOf(model, candidate);
  const line = candidates.line[candidate];
  const rows: [string, Node | string][] = [
    [capital(nouns.edge), candidateName(model, candidate)],
    ['In the file', `edge ${candidates.edge[candidate]}${line > 0 ? `, line ${line}` : ''}`],
    ['Verdict', html('span', { class: `verdict verdict-${verdict}` }, verdict)],
    ['Score', comparison(candidates.score[candidate], candidates.threshold[candidate])],
    ['Decided', stageInWords(stageOf(model, candidate))],
    ['Conflicts with', linksTo(model, store, conflictsOf(model, candidate))],
    ...contradicted(model, store, candidate),
    ...candidates.columns.map((column): [string, Node] => [
      capital(column.label),
      html(
        'span',
        { title: column.help },
        quantity(column.values[candidate], column.unit),
        html('span', { class: 'help' }, ` ${column.help}`),
      ),
    ]),
  ];
  return html(
    'dl',
    { class: 'facts' },
    ...rows.flatMap(([name, value]) => [html('dt', {}, name), html('dd', {}, value)]),
  );
}

/** What speaks for the verdict on the chosen candidate; follows the choice. */
export function reasonsBody(model: Model, store: Store): HTMLElement {
  const { edge } = model.nouns;
  const body = html('div', { 'aria-live': 'polite' });
  const show = (candidate: number) => {
    body.replaceChildren(
      candidate < 0
        ? absent(`Click ${aOrAn(edge)} on the map or in the table; N and P step through them.`)
        : reasons(model, store, candidate),
    );
  };
  store.subscribe((state, before) => {
    if (state.selected !== before.selected) show(state.selected);
  });
  show(store.state.selected);
  return body;
}

/** Why the chosen candidate was decided as it was. */
export function reasonsPanel(model: Model, store: Store): HTMLElement {
  return panel('reasons', `Why this ${model.nouns.edge}?`, reasonsBody(model, store));
}
