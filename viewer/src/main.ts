import { columnPanel } from './column_panel';
import type { Comparison } from './comparison';
import { COMPARISON_SCHEMA, differentFirst, readComparison } from './comparison';
import {
  agreementPanel,
  bothErrorsPanel,
  bothReasonsPanel,
  changedOptionsPanel,
  differencesPanel,
  resultsPanel,
  summariesPanel,
} from './comparison_page';
import { optionsPanel, roundsPanel } from './details_panel';
import { html } from './dom';
import { errorPanel } from './error_panel';
import { heatPanel } from './heat_panel';
import { mapPanel } from './map_panel';
import { inOrder, type Model, readModel, verdictCounts } from './model';
import { reasonsPanel } from './reasons_panel';
import { scorePanel } from './score_panel';
import { decayPanel, spectrumPanel } from './spectrum_panel';
import { Store } from './store';
import { summaryPanel } from './summary_panel';
import { tablePanel } from './table_panel';
import { tableSource } from './table_rows';
import { followTheme, preferredTheme } from './theme';

function fillHeader(header: HTMLElement, title: string, version: string, store: Store): void {
  const button = html('button', { type: 'button', id: 'theme' }, 'Light or dark');
  button.addEventListener('click', () =>
    store.update({ theme: store.state.theme === 'dark' ? 'light' : 'dark' }),
  );
  header.replaceChildren(
    html('h1', {}, title),
    html('p', { class: 'note' }, `Isotherm ${version}`),
    button,
  );
}

/** Milliseconds after which the rest of the page waits no longer for the map. */
const PATIENCE = 2000;

// What lies below the map waits until that is drawn, and then comes panel by panel.
async function fillLater(
  main: HTMLElement,
  drawn: Promise<unknown>,
  panels: (() => HTMLElement)[],
): Promise<void> {
  await Promise.race([drawn, new Promise((done) => setTimeout(done, PATIENCE))]);
  const next = () => {
    const make = panels.shift();
    if (!make) {
      document.documentElement.dataset.ready = 'true';
      return;
    }
    const element = make();
    // A panel without content would only be in the way.
    if (!element.querySelector(':scope > .absent')) main.append(element);
    setTimeout(next);
  };
  next();
}

/** The map of a pose graph is shown without the loops that were left out of it. */
function hiddenAtFirst(model: Model): Set<string> {
  const pruned = verdictCounts(model)[1] > 0;
  return new Set(model.kind === 'pose_graph' && pruned ? ['after:prune'] : []);
}

/** N and P go through the candidates, Escape chooses none, but where text is written. */
function stepByKeys(order: Uint32Array, store: Store): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const place = event.target as HTMLElement;
    const writes = place.matches?.('select, textarea, input:not([type=checkbox])') ?? false;
    if (writes) return;
    const by = { n: 1, p: -1 }[event.key.toLowerCase()];
    if (event.key === 'Escape') store.select(-1);
    if (by === undefined) return;
    store.step(by, order);
    event.preventDefault();
  });
}

/** The page without its panels: title, theme and keys; and where panels go. */
function begin(title: string, model: Model, order: Uint32Array): { main: HTMLElement; store: Store } {
  document.title = `${title} – Isotherm report`;
  const store = new Store({ selected: -1, hidden: hiddenAtFirst(model), theme: preferredTheme() });
  followTheme(store);
  stepByKeys(order, store);
  fillHeader(document.getElementById('header')!, title, model.version, store);
  return { main: document.getElementById('main')!, store };
}

function show(model: Model): void {
  const { main, store } = begin(model.title, model, inOrder(model));
  const map = mapPanel(model.layouts.map((layout) => ({ model, layout })), store);
  main.replaceChildren(summaryPanel(model), map.element);
  if (model.candidates.count > 0) main.append(reasonsPanel(model, store));
  void fillLater(main, map.drawn, [
    () => tablePanel(tableSource(model), store),
    () => scorePanel(model, store),
    () => heatPanel(model, store),
    () => columnPanel(model, store),
    () => errorPanel(model, store),
    () => spectrumPanel(model, store),
    () => decayPanel(model, store),
    () => roundsPanel(model),
    () => optionsPanel(model),
  ]);
}

function compare(comparison: Comparison): void {
  const { names, models } = comparison;
  const title = `${models[0].title}: ${names.join(' and ')}`;
  const { main, store } = begin(title, models[0], differentFirst(comparison));
  const map = resultsPanel(comparison, store);
  const first = [summariesPanel(comparison), agreementPanel(comparison), map.element];
  main.replaceChildren(...first);
  if (models[0].candidates.count > 0) main.append(bothReasonsPanel(comparison, store));
  void fillLater(main, map.drawn, [
    () => differencesPanel(comparison, store),
    () => bothErrorsPanel(comparison, store),
    () => changedOptionsPanel(comparison),
  ]);
}

function complain(error: unknown): void {
  const reason = error instanceof Error ? error.message : String(error);
  document
    .getElementById('main')!
    .replaceChildren(html('p', { class: 'damaged', role: 'alert' }, `This report cannot be shown: ${reason}.`));
  document.documentElement.dataset.ready = 'true';
}

try {
  const content = JSON.parse(document.getElementById('document')!.textContent ?? 'null');
  if (content?.schema === COMPARISON_SCHEMA) compare(readComparison(content));
  else show(readModel(content));
} catch (error) {
  complain(error);
}
