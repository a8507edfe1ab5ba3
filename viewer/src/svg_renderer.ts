import { svg } from './dom';
import type { Renderer } from './renderer';
import type { DrawLayer } from './scene';
import { colour } from './theme';
import type { Projection, View } from './view';
import { projectionOf, projectNode } from './view';

function lineData(layer: DrawLayer, projection: Projection): string {
  const parts: string[] = [];
  for (let k = 0; k < layer.lines.length; k += 2) {
    const [ax, ay] = projectNode(projection, layer.positions, layer.lines[k]);
    const [bx, by] = projectNode(projection, layer.positions, layer.lines[k + 1]);
    parts.push(`M${ax.toFixed(1)} ${ay.toFixed(1)}L${bx.toFixed(1)} ${by.toFixed(1)}`);
  }
  return parts.join('');
}

// A line of no length with round ends is a dot.
function pointData(layer: DrawLayer, projection: Projection): string {
  const parts: string[] = [];
  for (const node of layer.points) {
    const [x, y] = projectNode(projection, layer.positions, node);
    parts.push(`M${x.toFixed(1)} ${y.toFixed(1)}h0`);
  }
  return parts.join('');
}

function path(layer: DrawLayer, projection: Projection, stroke: string): SVGPathElement {
  return svg('path', {
    d: lineData(layer, projection) + pointData(layer, projection),
    class: `layer-${layer.key}`,
    fill: 'none',
    stroke,
    'stroke-width': layer.width,
    'stroke-opacity': layer.opacity,
    'stroke-dasharray': layer.dash?.join(' '),
    'stroke-linecap': layer.points.length > 0 ? 'round' : 'butt',
  });
}

function draw(group: SVGGElement, layers: readonly DrawLayer[], projection: Projection): void {
  const paths = layers.map((layer) => path(layer, projection, `var(${layer.colour})`));
  group.replaceChildren(...paths);
}

/** What a view sees as a picture of its own, in the colours of the page. */
export function mapSvg(
  title: string,
  layers: readonly DrawLayer[],
  view: View,
  width: number,
  height: number,
): SVGSVGElement {
  const projection = projectionOf(view, width, height);
  const viewBox = `0 0 ${width} ${height}`;
  return svg(
    'svg',
    { xmlns: 'http://www.w3.org/2000/svg', width, height, viewBox },
    svg('title', {}, title),
    svg('rect', { width, height, fill: colour('--card') }),
    ...layers.map((layer) => path(layer, projection, colour(layer.colour))),
  );
}

/** Draws inline SVG, where there is no WebGL. */
export class SvgRenderer implements Renderer {
  readonly limit = 3000;
  private readonly base = svg('g');
  private readonly highlight = svg('g');
  readonly element = svg('svg', { role: 'presentation' }, this.base, this.highlight);
  private layers: readonly DrawLayer[] = [];
  private over: readonly DrawLayer[] = [];

  setLayers(layers: readonly DrawLayer[]): void {
    this.layers = layers;
  }

  setHighlight(layers: readonly DrawLayer[]): void {
    this.over = layers;
  }

  render(view: View, width: number, height: number): void {
    this.element.setAttribute('viewBox', `0 0 ${width} ${height}`);
    const projection = projectionOf(view, width, height);
    draw(this.base, this.layers, projection);
    draw(this.highlight, this.over, projection);
  }
}
