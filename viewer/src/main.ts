import { columnPanel } from './column_panel';
import { optionsPanel, roundsPanel } from './details_panel';
import { html } from './dom';
import { errorPanel } from './error_panel';
import { heatPanel } from './heat_panel';
import { mapPanel } from './map_panel';
import { type Model, readModel, verdictCounts } from './model';
import { reasonsPanel } from './reasons_panel';
import { scorePanel } from './score_panel';
import { decayPanel, spectrumPanel } from './spectrum_panel';
import { Store } from './store';
import { summaryPanel } from './summary_panel';
import { tablePanel } from './table_panel';
import { followTheme, preferredTheme } from './theme';

function fillHeader(header: HTMLElement, model: Model, store: Store): void {
  const button = html('button', { type: 'button', id: 'theme' }, 'Light or dark');
  button.addEventListener('click', () =>
    store.update({ theme: store.state.theme === 'dark' ? 'light' : 'dark' }),
  );
  header.replaceChildren(
    html('h1', {}, model.title),
    html('p', { class: 'note' }, `Isotherm ${model.version}`),
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
function stepByKeys(model: Model, store: Store): void {
  document.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const place = event.target as HTMLElement;
    const writes = place.matches?.('select, textarea, input:not([type=checkbox])') ?? false;
    if (writes) return;
    const by = { n: 1, p: -1 }[event.key.toLowerCase()];
    if (event.key === 'Escape') store.select(-1);
    if (by === undefined) return;
    store.step(by, model.candidates.count);
    event.preventDefault();
  });
}

function show(model: Model): void {
  document.title = `${model.title} – Isotherm report`;
  const store = new Store({ selected: -1, hidden: hiddenAtFirst(model), theme: preferredTheme() });
  followTheme(store);
  stepByKeys(model, store);
  fillHeader(document.getElementById('header')!, model, store);
  const main = document.getElementById('main')!;
  const map = mapPanel(model, store);
  main.replaceChildren(summaryPanel(model), map.element, reasonsPanel(model, store));
  void fillLater(main, map.drawn, [
    () => tablePanel(model, store),
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

function complain(error: unknown): void {
  const reason = error instanceof Error ? error.message : String(error);
  document
    .getElementById('main')!
    .replaceChildren(html('p', { class: 'damaged', role: 'alert' }, `This report cannot be shown: ${reason}.`));
  document.documentElement.dataset.ready = 'true';
}

try {
  show(readModel(JSON.parse(document.getElementById('document')!.textContent ?? 'null')));
} catch (error) {
  complain(error);
}
