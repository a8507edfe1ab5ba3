import {
  BufferAttribute,
  BufferGeometry,
  Color,
  Group,
  LineBasicMaterial,
  LineSegments,
  type Material,
  type Object3D,
  OrthographicCamera,
  Points,
  PointsMaterial,
  Scene,
  Sphere,
  Vector3,
  WebGLRenderer,
} from 'three';
import { LineMaterial } from 'three/examples/jsm/lines/LineMaterial.js';
import { LineSegments2 } from 'three/examples/jsm/lines/LineSegments2.js';
import { LineSegmentsGeometry } from 'three/examples/jsm/lines/LineSegmentsGeometry.js';
import type { Renderer } from './renderer';
import type { DrawLayer } from './scene';
import { colour } from './theme';
import type { View } from './view';
import { axesOf } from './view';

/** Layers with more lines than this get lines of one pixel, which cost far less. */
const WIDE_LINES = 5000;

function material<M extends Material>(m: M, layer: DrawLayer): M {
  m.transparent = true;
  m.opacity = layer.opacity;
  // Layers lie over each other in their own order, seen from anywhere.
  m.depthTest = false;
  m.depthWrite = false;
  return m;
}

function wideLines(layer: DrawLayer): Object3D {
  const ends = new Float32Array(3 * layer.lines.length);
  layer.lines.forEach((node, k) => {
    ends.set(layer.positions.subarray(3 * node, 3 * node + 3), 3 * k);
  });
  const geometry = new LineSegmentsGeometry();
  geometry.setPositions(ends);
  const style = new LineMaterial({
    color: colour(layer.colour),
    linewidth: layer.width,
    dashed: layer.dash !== null,
    dashSize: layer.dash?.[0] ?? 1,
    gapSize: layer.dash?.[1] ?? 1,
  });
  const lines = new LineSegments2(geometry, material(style, layer));
  if (layer.dash) lines.computeLineDistances();
  return lines;
}

function indexed(layer: DrawLayer, index: Uint32Array): BufferGeometry {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(layer.positions, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  // Nothing is culled; nodes without a place, which no index names, must not be measured.
  geometry.boundingSphere = new Sphere(new Vector3(), Infinity);
  return geometry;
}

function objectsOf(layer: DrawLayer): Object3D[] {
  const objects: Object3D[] = [];
  const color = new Color(colour(layer.colour));
  if (layer.lines.length > 2 * WIDE_LINES) {
    const style = material(new LineBasicMaterial({ color }), layer);
    objects.push(new LineSegments(indexed(layer, layer.lines), style));
  } else if (layer.lines.length > 0) {
    objects.push(wideLines(layer));
  }
  if (layer.points.length > 0) {
    const style = new PointsMaterial({
      color,
      size: layer.width * devicePixelRatio,
      sizeAttenuation: false,
    });
    objects.push(new Points(indexed(layer, layer.points), material(style, layer)));
  }
  return objects;
}

function dispose(group: Group): void {
  for (const object of group.children) {
    const drawn = object as LineSegments | Points;
    drawn.geometry.dispose();
    (drawn.material as Material).dispose();
  }
  group.clear();
}

function fill(group: Group, layers: readonly DrawLayer[], firstOrder: number): void {
  dispose(group);
  layers.forEach((layer, order) => {
    for (const object of objectsOf(layer)) {
      object.renderOrder = firstOrder + order;
      object.frustumCulled = false;
      group.add(object);
    }
  });
}

/** Draws with the graphics card. The constructor throws where there is no WebGL. */
export class WebGlRenderer implements Renderer {
  readonly limit = 20000;
  readonly element: HTMLCanvasElement;
  private readonly gl: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly base = new Group();
  private readonly highlight = new Group();
  private readonly camera = new OrthographicCamera();

  constructor(onLost: () => void) {
    const canvas = document.createElement('canvas');
    // Kept until the next frame, so that the map is there when the page is printed.
    const wishes = { antialias: true, alpha: true, preserveDrawingBuffer: true };
    const context = canvas.getContext('webgl2', wishes) as WebGLRenderingContext | null;
    if (!context) throw new Error('there is no WebGL');
    this.gl = new WebGLRenderer({ canvas, context, ...wishes });
    this.gl.setClearAlpha(0);
    this.gl.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.element = canvas;
    this.element.addEventListener('webglcontextlost', onLost, { once: true });
    this.scene.add(this.base, this.highlight);
  }

  setLayers(layers: readonly DrawLayer[]): void {
    fill(this.base, layers, 0);
  }

  setHighlight(layers: readonly DrawLayer[]): void {
    fill(this.highlight, layers, 1000);
  }

  render(view: View, width: number, height: number): void {
    this.gl.setSize(width, height, false);
    const { right, up } = axesOf(view);
    const [r, u] = [new Vector3(...right), new Vector3(...up)];
    const reach = 1e6 / view.scale;
    this.camera.left = -width / 2 / view.scale;
    this.camera.right = -this.camera.left;
    this.camera.top = height / 2 / view.scale;
    this.camera.bottom = -this.camera.top;
    this.camera.near = -reach;
    this.camera.far = reach;
    this.camera.up.copy(u);
    this.camera.position.set(...view.centre);
    this.camera.lookAt(new Vector3(...view.centre).sub(r.cross(u)));
    this.camera.updateProjectionMatrix();
    for (const object of [...this.base.children, ...this.highlight.children]) {
      const style = (object as LineSegments2).material;
      if (!(style instanceof LineMaterial)) continue;
      style.resolution.set(width, height);
      // Dashes are given in pixels, whatever the scale.
      style.dashScale = view.scale;
    }
    this.gl.render(this.scene, this.camera);
  }
}
