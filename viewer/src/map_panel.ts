import { html, panel } from './dom';
import { aOrAn, count } from './format';
import { layerBox } from './layer_box';
import { MapView } from './map_view';
import type { Layout, Model } from './model';
import type { LegendEntry } from './scene';
import { legendOf } from './scene';
import type { Store } from './store';

function layerToggle(entry: LegendEntry, store: Store): HTMLElement {
  const sign = html('span', { class: `sign sign-${entry.shape} sign-${entry.key}` });
  sign.style.setProperty('--sign', `var(${entry.colour})`);
  return layerBox(entry.key, store, sign, `${entry.label} (${entry.counts.map(count).join(' / ')})`);
}

/** A layout of a report, to be drawn. */
export interface Shown {
  model: Model;
  layout: Layout;
}

/**
 * Maps side by side, with the legend that switches layers; and when they were drawn for the
 * first time. All are of one graph.
 */
export function mapPanel(shown: Shown[], store: Store): { element: HTMLElement; drawn: Promise<unknown> } {
  const { model } = shown[0];
  const models = [...new Set(shown.map((one) => one.model))];
  const legend = html(
    'div',
    { class: 'legend', role: 'group', 'aria-label': 'Layers' },
    ...legendOf(models).map((entry) => layerToggle(entry, store)),
  );
  const views = shown.map((one) => new MapView(one.model, one.layout, store));
  const hint =
    model.dimension === 3
      ? 'Drag to turn, with Shift to move. Click the map first to zoom with the wheel.'
      : 'Drag to move. Click the map first to zoom with the wheel.';
  const element = panel(
    'map',
    'Map',
    legend,
    html('div', { class: 'maps' }, ...views.map((view) => view.element)),
    html('p', { class: 'note screen-only' }, `${hint} Click ${aOrAn(model.nouns.edge)} for its reasons.`),
  );
  return { element, drawn: Promise.all(views.map((view) => view.drawn)) };
}
