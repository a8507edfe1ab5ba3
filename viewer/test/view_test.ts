import assert from 'node:assert/strict';
import test from 'node:test';
import { fitted, initialView, panned, projectionOf, projectNode, turned, zoomed } from '../src/view';

const [WIDTH, HEIGHT] = [600, 400];
const POINTS = Float32Array.from([0, 0, 0, 10, 0, 0, 10, 5, 0, 3, 4, 2]);

function near(actual: [number, number], expected: [number, number]): void {
  assert.ok(Math.hypot(actual[0] - expected[0], actual[1] - expected[1]) < 1e-6, `${actual}`);
}

test('the plane is seen from above, x to the right and y up', () => {
  const view = { ...initialView(2), scale: 10 };
  const projection = projectionOf(view, WIDTH, HEIGHT);
  near(projectNode(projection, POINTS, 0), [300, 200]);
  near(projectNode(projection, POINTS, 2), [400, 150]);
});

test('a fitted view shows every point', () => {
  for (const dimension of [2, 3]) {
    const view = fitted(initialView(dimension), POINTS, WIDTH, HEIGHT);
    const projection = projectionOf(view, WIDTH, HEIGHT);
    for (let k = 0; k < 4; ++k) {
      const [x, y] = projectNode(projection, POINTS, k);
      assert.ok(x >= 0 && x <= WIDTH && y >= 0 && y <= HEIGHT);
    }
  }
});

test('nothing, one point and unknown points have a view', () => {
  for (const points of [[], [1, 2, 3], [NaN, NaN, NaN]]) {
    const view = fitted(initialView(2), Float32Array.from(points), WIDTH, HEIGHT);
    assert.ok(Number.isFinite(view.scale) && view.centre.every(Number.isFinite));
  }
});

test('what is under the pointer stays there while the map is moved and scaled', () => {
  const view = turned(fitted(initialView(3), POINTS, WIDTH, HEIGHT), 0.4, 0.2);
  const place = (v: typeof view) => projectNode(projectionOf(v, WIDTH, HEIGHT), POINTS, 3);
  const [x, y] = place(view);
  near(place(zoomed(view, 2.5, x, y, WIDTH, HEIGHT)), [x, y]);
  near(place(panned(view, 30, -20)), [x + 30, y - 20]);
});

test('the eye never turns upside down', () => {
  assert.ok(turned(initialView(3), 0, 100).pitch <= Math.PI / 2);
  assert.ok(turned(initialView(3), 0, -100).pitch >= -Math.PI / 2);
});
