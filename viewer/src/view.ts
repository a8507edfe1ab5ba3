/** How the map is looked at: an orthographic camera. Angles in radians. */
export interface View {
  /** point of the layout at the middle of the picture */
  centre: [number, number, number];
  /** pixels a unit of the layout */
  scale: number;
  /** turn about the vertical */
  yaw: number;
  /** height of the eye: a right angle looks straight down */
  pitch: number;
}

/** The two directions of the layout that run to the right and up in the picture. */
export interface Axes {
  right: [number, number, number];
  up: [number, number, number];
}

/** Where in the picture a point of the layout is: x = ax + bx . p, in pixels. */
export interface Projection {
  offset: [number, number];
  right: [number, number, number];
  down: [number, number, number];
}

const MARGIN = 24;
const LARGEST_PITCH = Math.PI / 2;

export function axesOf(view: View): Axes {
  const [cy, sy] = [Math.cos(view.yaw), Math.sin(view.yaw)];
  const [cp, sp] = [Math.cos(view.pitch), Math.sin(view.pitch)];
  return { right: [cy, sy, 0], up: [-sp * sy, sp * cy, cp] };
}

/** The first look at a layout of the plane or of space. */
export function initialView(dimension: number): View {
  return dimension < 3
    ? { centre: [0, 0, 0], scale: 1, yaw: 0, pitch: Math.PI / 2 }
    : { centre: [0, 0, 0], scale: 1, yaw: Math.PI / 6, pitch: Math.PI / 6 };
}

function dot(a: readonly number[], b: readonly number[]): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function projectionOf(view: View, width: number, height: number): Projection {
  const { right, up } = axesOf(view);
  const s = view.scale;
  return {
    offset: [width / 2 - s * dot(right, view.centre), height / 2 + s * dot(up, view.centre)],
    right: [s * right[0], s * right[1], s * right[2]],
    down: [-s * up[0], -s * up[1], -s * up[2]],
  };
}

/** Pixel coordinates of node `k`; `positions` has three numbers a node. */
export function projectNode(p: Projection, positions: Float32Array, k: number): [number, number] {
  const [x, y, z] = [positions[3 * k], positions[3 * k + 1], positions[3 * k + 2]];
  return [
    p.offset[0] + p.right[0] * x + p.right[1] * y + p.right[2] * z,
    p.offset[1] + p.down[0] * x + p.down[1] * y + p.down[2] * z,
  ];
}

/** The same look, moved and scaled so that all positions are in the picture. */
export function fitted(view: View, positions: Float32Array, width: number, height: number): View {
  const { right, up } = axesOf(view);
  const low = [Infinity, Infinity];
  const high = [-Infinity, -Infinity];
  for (let k = 0; k < positions.length; k += 3) {
    const point = [positions[k], positions[k + 1], positions[k + 2]];
    const along = [dot(right, point), dot(up, point)];
    for (let d = 0; d < 2; ++d) {
      if (along[d] < low[d]) low[d] = along[d];
      if (along[d] > high[d]) high[d] = along[d];
    }
  }
  if (!(high[0] >= low[0])) return { ...view, centre: [0, 0, 0], scale: 1 };
  const size = [high[0] - low[0], high[1] - low[1]];
  const scale = Math.min(
    Math.max(width - 2 * MARGIN, 1) / size[0],
    Math.max(height - 2 * MARGIN, 1) / size[1],
  );
  const [a, b] = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
  return {
    ...view,
    centre: [0, 1, 2].map((d) => a * right[d] + b * up[d]) as [number, number, number],
    scale: Number.isFinite(scale) ? scale : 1,
  };
}

/** Moved by pixels: what is in the picture follows the pointer. */
export function panned(view: View, dx: number, dy: number): View {
  const { right, up } = axesOf(view);
  const centre = view.centre.map(
    (c, d) => c + (-dx * right[d] + dy * up[d]) / view.scale,
  ) as View['centre'];
  return { ...view, centre };
}

/** Scaled by `factor` about the pixel (x, y) of a picture of that size. */
export function zoomed(
  view: View,
  factor: number,
  x: number,
  y: number,
  width: number,
  height: number,
): View {
  const [dx, dy] = [x - width / 2, y - height / 2];
  const moved = panned(view, -dx, -dy);
  return panned({ ...moved, scale: view.scale * factor }, dx, dy);
}

/** Turned by radians; the eye stays above the horizon or below it, never upside down. */
export function turned(view: View, yaw: number, pitch: number): View {
  const height = Math.max(-LARGEST_PITCH, Math.min(LARGEST_PITCH, view.pitch + pitch));
  return { ...view, yaw: view.yaw + yaw, pitch: height };
}
