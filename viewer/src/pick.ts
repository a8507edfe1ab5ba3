import type { DrawLayer } from './scene';
import type { Projection } from './view';
import { projectNode } from './view';

/** Squared distance of (x, y) from the segment a-b. */
export function squaredDistance(
  x: number,
  y: number,
  a: readonly [number, number],
  b: readonly [number, number],
): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const length = dx * dx + dy * dy;
  const along = length > 0 ? ((x - a[0]) * dx + (y - a[1]) * dy) / length : 0;
  const t = Math.max(0, Math.min(1, along));
  const [ex, ey] = [a[0] + t * dx - x, a[1] + t * dy - y];
  return ex * ex + ey * ey;
}

/** The nearest of what is offered, if it is within `reach`; of equals the last. */
class Nearest {
  found = -1;
  private least: number;

  constructor(reach: number) {
    this.least = reach * reach;
  }

  offer(what: number, squared: number): void {
    if (!(squared <= this.least)) return;
    this.least = squared;
    this.found = what;
  }
}

/** The candidate whose line is nearest to a pixel, if one is within `reach`; else -1. */
export function pick(
  layers: readonly DrawLayer[],
  projection: Projection,
  x: number,
  y: number,
  reach: number,
): number {
  const nearest = new Nearest(reach);
  for (const layer of layers) {
    if (!layer.candidates) continue;
    for (let k = 0; k < layer.candidates.length; ++k) {
      const from = projectNode(projection, layer.positions, layer.lines[2 * k]);
      const to = projectNode(projection, layer.positions, layer.lines[2 * k + 1]);
      nearest.offer(layer.candidates[k], squaredDistance(x, y, from, to));
    }
  }
  return nearest.found;
}

/** The node that is nearest to a pixel, if one is within `reach`; else -1. */
export function nearestNode(
  projection: Projection,
  positions: Float32Array,
  x: number,
  y: number,
  reach: number,
): number {
  const nearest = new Nearest(reach);
  for (let node = 0; 3 * node < positions.length; ++node) {
    const [px, py] = projectNode(projection, positions, node);
    nearest.offer(node, (px - x) ** 2 + (py - y) ** 2);
  }
  return nearest.found;
}
