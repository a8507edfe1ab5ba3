import type { DrawLayer } from './scene';
import type { View } from './view';

/** Draws layers of lines and points as a view sees them. */
export interface Renderer {
  readonly element: HTMLElement | SVGElement;
  /** candidates a verdict that are drawn without delay */
  readonly limit: number;
  /** what is always there, undermost first */
  setLayers(layers: readonly DrawLayer[]): void;
  /** what lies over it: the chosen candidate */
  setHighlight(layers: readonly DrawLayer[]): void;
  render(view: View, width: number, height: number): void;
}
