import assert from 'node:assert/strict';
import test from 'node:test';
import { candidateWords, nodeWords } from '../src/map_words';
import { nearestNode, pick, squaredDistance } from '../src/pick';
import { buildScene, inSpace, joined, legendOf, thinned } from '../src/scene';
import { fitted, initialView, projectionOf, projectNode } from '../src/view';
import { f32, i32, squareDocument, squareModel, u8 } from './fixture';
import { type Model, readModel } from '../src/model';

test('thinning keeps the ends of the range apart evenly', () => {
  assert.deepEqual([...thinned(3, 10)], [0, 1, 2]);
  assert.deepEqual([...thinned(10, 5)], [0, 2, 4, 6, 8]);
  assert.equal(thinned(0, 5).length, 0);
});

test('runs of a path are joined, breaks stay breaks', () => {
  const path = Int32Array.from([0, 1, 1, 2, 2, 3, 7, 8, 8, 9]);
  assert.deepEqual([...joined(path, 10)], [...path]);
  assert.deepEqual([...joined(path, 2)], [0, 3, 7, 9]);
});

test('planar points lie at height 0', () => {
  assert.deepEqual([...inSpace(Float32Array.from([1, 2, 3, 4]), 2)], [1, 2, 0, 3, 4, 0]);
});

test('every candidate is on the map, and what is thinned is said', () => {
  const model = squareModel();
  const scene = buildScene(model, model.layouts[0], 10);
  const drawn = scene.layers.flatMap((layer) => [...(layer.candidates ?? [])]);
  assert.deepEqual(drawn.sort(), [0, 1, 2]);
  assert.deepEqual(scene.notes, []);
  const document = squareDocument();
  document.candidates.verdict = { u8: 'AAAA' };
  const kept = readModel(document);
  assert.match(buildScene(kept, kept.layouts[0], 2).notes.join(), /2 of 3 kept loops/);
});

test('edges without a place are left out', () => {
  const document = squareDocument();
  document.layouts[0].positions = f32([0, 0, NaN, NaN, 1, 1, 0, 1]);
  const model = readModel(document);
  const layers = buildScene(model, model.layouts[0], 10).layers;
  assert.equal(layers.find(({ key }) => key === 'prune')?.lines.length, 0);
  assert.deepEqual([...layers.find(({ key }) => key === 'trusted')!.lines], [2, 3]);
});

test('robots have paths of their own, each with a name and a colour', () => {
  const document = squareDocument();
  document.nodes.robots = { names: ['a', 'b'], of: i32([0, 0, 1, 1]) };
  const model = readModel(document);
  const layers = buildScene(model, model.layouts[0], 10).layers;
  const paths = layers.filter(({ key }) => key.startsWith('trusted'));
  assert.deepEqual(paths.map(({ key, colour, lines }) => [key, colour, lines.length]), [
    ['trusted-0', '--robot-1', 4],
    ['trusted-1', '--robot-2', 2],
  ]);
  const labels = legendOf([model]).map(({ label, counts }) => `${label} ${counts}`);
  assert.ok(labels.includes('odometry of a 2') && labels.includes('odometry of b 1'), labels.join());
});

test('the legend counts', () => {
  const entries = (...models: Model[]) =>
    legendOf(models).map(({ key, counts }) => `${key} ${counts.join('/')}`);
  assert.deepEqual(entries(squareModel()), ['keep 1', 'prune 1', 'ambiguous 1', 'trusted 3']);
  const document = squareDocument();
  document.candidates.verdict = u8([0, 0, 0]);
  const kept = readModel(document);
  assert.deepEqual(entries(kept), ['keep 3', 'trusted 3'], 'what is not there is left out');
  assert.deepEqual(entries(kept, squareModel()), ['keep 3/1', 'prune 0/1', 'ambiguous 0/1', 'trusted 3']);
});

test('the nearest line is picked', () => {
  assert.equal(squaredDistance(0, 3, [0, 0], [0, 0]), 9);
  assert.equal(squaredDistance(5, 3, [0, 0], [10, 0]), 9);
  assert.equal(squaredDistance(13, 4, [0, 0], [10, 0]), 25);
  const model = squareModel();
  const { layers } = buildScene(model, model.layouts[0], 10);
  const positions = layers[0].positions;
  const projection = projectionOf(fitted(initialView(2), positions, 400, 400), 400, 400);
  const [ax, ay] = projectNode(projection, positions, 0);
  const [bx, by] = projectNode(projection, positions, 3);
  assert.equal(pick(layers, projection, (ax + bx) / 2 - 3, (ay + by) / 2, 8), 0);
  assert.equal(pick(layers, projection, ax - 50, ay, 8), -1);
  assert.equal(nearestNode(projection, positions, ax + 3, ay - 3, 8), 0);
  assert.equal(nearestNode(projection, positions, ax + 30, ay, 8), -1);
});

test('a node without a place is never near', () => {
  const projection = projectionOf(initialView(2), 100, 100);
  assert.equal(nearestNode(projection, Float32Array.from([NaN, NaN, 0]), 50, 50, 1000), -1);
});

test('the pointer is told every value', () => {
  const model = squareModel();
  assert.deepEqual(candidateWords(model, 1), [
    'loop 2 – 18446744073709551615: prune, refuted',
    'score: 100, threshold 10',
    'χ²: 50',
  ]);
  const document = squareDocument();
  Object.assign(document.layouts[0], { origin: [100, -1], errors: f32([0, 0, 0.25, 0]) });
  document.nodes.robots = { names: ['a', 'b'], of: i32([0, 0, 1, 1]) };
  const other = readModel(document);
  assert.deepEqual(nodeWords(other, other.layouts[0], 2), [
    'pose 10: (101, 0) m',
    'robot: b',
    'error: 0.25 m',
  ]);
});
