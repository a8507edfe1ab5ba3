import { html } from './dom';
import type { Store } from './store';

/** A box that shows and hides a layer, and follows what other boxes do to it. */
export function layerBox(key: string, store: Store, ...label: (Node | string)[]): HTMLElement {
  const shown = () => !store.state.hidden.has(key);
  const box = html('input', { type: 'checkbox', checked: shown(), 'data-layer': key });
  box.addEventListener('change', () => store.toggleLayer(key, box.checked));
  store.subscribe(() => (box.checked = shown()));
  return html('label', { class: 'layer' }, box, ...label);
}
