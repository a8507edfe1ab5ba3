import { svg } from './dom';
import type { Renderer } from './renderer';
import type { DrawLayer } from './scene';
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

function draw(group: SVGGElement, layers: readonly DrawLayer[], projection: Projection): void {
  group.replaceChildren(
    ...layers.map((layer) =>
      svg('path', {
        d: lineData(layer, projection) + pointData(layer, projection),
        class: `layer-${layer.key}`,
        fill: 'none',
        stroke: `var(${layer.colour})`,
        'stroke-width': layer.width,
        'stroke-opacity': layer.opacity,
        'stroke-dasharray': layer.dash?.join(' '),
        'stroke-linecap': layer.points.length > 0 ? 'round' : 'butt',
      }),
    ),
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
