import { columnPanel } from './column_panel';
import { optionsPanel, roundsPanel } from './details_panel';
import { html } from './dom';
import { errorPanel } from './error_panel';
import { heatPanel } from './heat_panel';
import { mapPanel } from './map_panel';
import { type Model, readModel } from './model';
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
    main.append(make());
    setTimeout(next);
  };
  next();
}

function show(model: Model): void {
  document.title = `${model.title} – Isotherm report`;
  const store = new Store({ selected: -1, hidden: new Set(), theme: preferredTheme() });
  followTheme(store);
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
