import { html } from './dom';
import { quantity, roundLength } from './format';
import { listenToGestures } from './gestures';
import { layerBox } from './layer_box';
import { candidateWords, nodeWords } from './map_words';
import type { Layout, Model } from './model';
import { conflictsOf } from './model';
import { nearestNode, pick } from './pick';
import type { Renderer } from './renderer';
import { saveButtons } from './save';
import type { DrawLayer, Scene } from './scene';
import { buildScene, inSpace } from './scene';
import type { Store } from './store';
import { mapSvg, SvgRenderer } from './svg_renderer';
import { WebGlRenderer } from './webgl_renderer';
import type { View } from './view';
import { fitted, initialView, panned, projectionOf, turned, zoomed } from './view';

const REACH = 8;
const STEP = 40;
const TURN = 0.01;
const SCALE_BAR = 0.25;

const KEYS =
  'Arrow keys move, with Shift they turn a map of space; plus and minus zoom, 0 fits, ' +
  'N and P choose the next and the previous';

/** One layout on the map, with everything a person can do to it. */
export class MapView {
  readonly element: HTMLElement;
  private readonly stage: HTMLElement;
  private readonly tooltip = html('div', { class: 'tooltip', role: 'status', hidden: true });
  private readonly bar = html('div', { class: 'scale-bar' });
  private readonly note = html('figcaption', { class: 'note' });
  private readonly positions: Float32Array;
  private renderer: Renderer;
  private scene: Scene;
  private view: View;
  private width = 0;
  private height = 0;
  private pending = false;
  private tellDrawn!: () => void;
  /** Done when the map was drawn for the first time. */
  readonly drawn = new Promise<void>((done) => (this.tellDrawn = done));

  constructor(
    private readonly model: Model,
    private readonly layout: Layout,
    private readonly store: Store,
  ) {
    this.positions = inSpace(layout.positions, model.dimension);
    this.view = initialView(model.dimension);
    this.stage = html('div', {
      class: 'stage',
      tabindex: 0,
      role: 'application',
      'aria-label': `Map. ${layout.label}. ${KEYS}.`,
    });
    this.renderer = this.createRenderer();
    this.scene = buildScene(model, layout, this.renderer.limit);
    this.stage.append(this.renderer.element, this.bar, this.tooltip);
    this.element = html(
      'figure',
      { class: 'map', 'data-layout': layout.key },
      html('div', { class: 'map-head' }, html('h3', {}, layout.label), ...this.prunedSwitch(), this.buttons()),
      this.stage,
      this.note,
    );
    this.showScene();
    this.listen();
  }

  /** Which of the two ways of drawing is in use. */
  get drawnBy(): string {
    return this.renderer instanceof SvgRenderer ? 'svg' : 'webgl';
  }

  private createRenderer(): Renderer {
    try {
      return new WebGlRenderer(() => this.fallBack());
    } catch {
      return new SvgRenderer();
    }
  }

  // The graphics card can go away at any time.
  private fallBack(): void {
    const before = this.renderer.element;
    this.renderer = new SvgRenderer();
    before.replaceWith(this.renderer.element);
    this.scene = buildScene(this.model, this.layout, this.renderer.limit);
    this.showScene();
  }

  // The map that is the result shows itself; what was left out of it is there when asked for.
  private prunedSwitch(): HTMLElement[] {
    const key = `${this.layout.key}:prune`;
    if (!this.store.state.hidden.has(key)) return [];
    return [layerBox(key, this.store, `pruned ${this.model.nouns.edges}`)];
  }

  private buttons(): HTMLElement {
    const button = (label: string, sign: string, action: () => void) => {
      const element = html('button', { type: 'button', 'aria-label': label, title: label }, sign);
      element.addEventListener('click', action);
      return element;
    };
    const about = (factor: number) => this.zoom(factor, this.width / 2, this.height / 2);
    return html(
      'div',
      { class: 'buttons', role: 'group', 'aria-label': 'View' },
      saveButtons(this.model.title, `map-${this.layout.key}`, { svg: () => this.picture() }),
      button('Zoom in', '+', () => about(1.4)),
      button('Zoom out', '−', () => about(1 / 1.4)),
      button('Fit', '⤢', () => this.fit()),
    );
  }

  private picture(): SVGSVGElement {
    const layers = [...this.visibleLayers(), ...this.highlight()];
    const title = `${this.model.title}. ${this.layout.label}`;
    return mapSvg(title, layers, this.view, this.width, this.height);
  }

  private showScene(): void {
    this.element.dataset.drawnBy = this.drawnBy;
    this.note.textContent = this.scene.notes.join(' ');
    this.renderer.setLayers(this.visibleLayers());
    this.renderer.setHighlight(this.highlight());
    this.schedule();
  }

  private visibleLayers(): DrawLayer[] {
    const { hidden } = this.store.state;
    return this.scene.layers.filter(
      ({ key }) => !hidden.has(key) && !hidden.has(`${this.layout.key}:${key}`),
    );
  }

  private highlight(): DrawLayer[] {
    const { selected } = this.store.state;
    if (selected < 0) return [];
    return [
      this.overlay('conflicts', conflictsOf(this.model, selected), '--conflict', 2),
      this.overlay('selected', [selected], '--selected', 4),
    ];
  }

  private overlay(key: string, candidates: number[], colour: string, width: number): DrawLayer {
    const { from, to } = this.model.candidates;
    const lines = candidates.flatMap((k) => [from[k], to[k]]);
    const known = lines.every((node) => Number.isFinite(this.positions[3 * node]));
    return {
      key,
      positions: this.positions,
      lines: Uint32Array.from(known ? lines : []),
      points: Uint32Array.from(known && key === 'selected' ? lines : []),
      candidates: null,
      colour,
      width,
      opacity: 1,
      dash: null,
    };
  }

  private listen(): void {
    this.store.subscribe((state, before) => {
      if (state.hidden !== before.hidden || state.theme !== before.theme) {
        this.showScene();
      } else if (state.selected !== before.selected) {
        this.renderer.setHighlight(this.highlight());
        this.schedule();
      }
    });
    listenToGestures(
      this.stage,
      {
        pan: (dx, dy) => this.look(panned(this.view, dx, dy)),
        turn: (dx, dy) => this.look(turned(this.view, -dx * TURN, dy * TURN)),
        zoom: (factor, x, y) => this.zoom(factor, x, y),
        hover: (x, y) => this.hover(x, y),
        leave: () => this.hideTooltip(),
        click: (x, y) => this.click(x, y),
      },
      this.model.dimension === 3,
    );
    this.stage.addEventListener('keydown', (event) => {
      if (event.ctrlKey || event.metaKey || event.altKey) return;
      if (this.press(event.key, event.shiftKey)) event.preventDefault();
    });
    new ResizeObserver(() => this.resize()).observe(this.stage);
  }

  /** Whether the key means something here. */
  private press(key: string, shift: boolean): boolean {
    const arrow = { ArrowLeft: [1, 0], ArrowRight: [-1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[
      key
    ];
    if (arrow) {
      const [dx, dy] = [arrow[0] * STEP, arrow[1] * STEP];
      const turns = shift && this.model.dimension === 3;
      this.look(
        turns ? turned(this.view, dx * TURN, -dy * TURN) : panned(this.view, dx, dy),
      );
      return true;
    }
    const about = (factor: number) => this.zoom(factor, this.width / 2, this.height / 2);
    const actions: Record<string, () => void> = {
      '+': () => about(1.25),
      '=': () => about(1.25),
      '-': () => about(0.8),
      '0': () => this.fit(),
      Escape: () => this.store.select(-1),
    };
    const action = actions[key] ?? actions[key.toLowerCase()];
    action?.();
    return action !== undefined;
  }

  private resize(): void {
    const first = this.width === 0;
    this.width = this.stage.clientWidth;
    this.height = this.stage.clientHeight;
    if (first) this.fit();
    else this.schedule();
  }

  private fit(): void {
    this.look(fitted(this.view, this.positions, this.width, this.height));
  }

  private zoom(factor: number, x: number, y: number): void {
    this.look(zoomed(this.view, factor, x, y, this.width, this.height));
  }

  private look(view: View): void {
    this.view = view;
    this.hideTooltip();
    this.schedule();
  }

  // Any number of changes between two frames cost one drawing.
  private schedule(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      if (this.width > 0 && this.height > 0) this.draw();
    });
  }

  private draw(): void {
    this.renderer.render(this.view, this.width, this.height);
    this.drawScaleBar();
    this.element.dataset.drawn = 'true';
    this.tellDrawn();
  }

  private drawScaleBar(): void {
    this.bar.hidden = this.model.unit === '';
    const length = roundLength((SCALE_BAR * this.width) / this.view.scale);
    this.bar.textContent = quantity(length, this.model.unit);
    this.bar.style.width = `${length * this.view.scale}px`;
  }

  private at(x: number, y: number): number {
    const projection = projectionOf(this.view, this.width, this.height);
    return pick(this.visibleLayers(), projection, x, y, REACH);
  }

  private click(x: number, y: number): void {
    this.stage.focus({ preventScroll: true });
    this.store.select(this.at(x, y));
  }

  private hover(x: number, y: number): void {
    const candidate = this.at(x, y);
    const projection = projectionOf(this.view, this.width, this.height);
    const node = nearestNode(projection, this.positions, x, y, REACH);
    const words = [
      ...(candidate < 0 ? [] : candidateWords(this.model, candidate)),
      ...(node < 0 ? [] : nodeWords(this.model, this.layout, node)),
    ];
    this.tooltip.hidden = words.length === 0;
    this.tooltip.dataset.about = [candidate < 0 ? '' : 'edge', node < 0 ? '' : 'node'].join(' ').trim();
    this.tooltip.textContent = words.join('\n');
    this.placeTooltip(x, y);
  }

  // Beside the pointer, and inside of the map.
  private placeTooltip(x: number, y: number): void {
    const { offsetWidth, offsetHeight } = this.tooltip;
    const left = Math.min(x + 12, this.width - offsetWidth - 4);
    const below = y + 14 + offsetHeight < this.height;
    const top = below ? y + 14 : y - 8 - offsetHeight;
    this.tooltip.style.transform = `translate(${Math.max(left, 4)}px, ${Math.max(top, 0)}px)`;
  }

  private hideTooltip(): void {
    this.tooltip.hidden = true;
  }
}
