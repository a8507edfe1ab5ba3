import { html, panel } from './dom';
import { count } from './format';
import { MapView } from './map_view';
import type { Model } from './model';
import type { LegendEntry } from './scene';
import { legendOf } from './scene';
import type { Store } from './store';

function layerToggle(entry: LegendEntry, store: Store): HTMLElement {
  const box = html('input', { type: 'checkbox', checked: true, 'data-layer': entry.key });
  box.addEventListener('change', () => store.toggleLayer(entry.key, box.checked));
  const sign = html('span', { class: `sign sign-${entry.shape} sign-${entry.key}` });
  sign.style.setProperty('--sign', `var(${entry.colour})`);
  return html('label', { class: 'layer' }, box, sign, `${entry.label} (${count(entry.count)})`);
}

/**
 * The map before and after, side by side, with the legend that switches layers; and when
 * it was drawn for the first time.
 */
export function mapPanel(model: Model, store: Store): { element: HTMLElement; drawn: Promise<unknown> } {
  const legend = html(
    'div',
    { class: 'legend', role: 'group', 'aria-label': 'Layers' },
    ...legendOf(model).map((entry) => layerToggle(entry, store)),
  );
  const views = model.layouts.map((layout) => new MapView(model, layout, store));
  const hint =
    model.dimension === 3
      ? 'Drag to turn, with Shift to move. Click the map first to zoom with the wheel.'
      : 'Drag to move. Click the map first to zoom with the wheel.';
  const element = panel(
    'map',
    'Map',
    legend,
    html('div', { class: 'maps' }, ...views.map((view) => view.element)),
    html('p', { class: 'note screen-only' }, `${hint} Click a ${model.nouns.edge} for its reasons.`),
  );
  return { element, drawn: Promise.all(views.map((view) => view.drawn)) };
}
