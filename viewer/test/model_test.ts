import assert from 'node:assert/strict';
import test from 'node:test';
import { conflictsOf, nodeName, readModel, stageOf, verdictCounts, verdictOf } from '../src/model';
import { f32, i32, squareDocument, squareModel } from './fixture';

test('a document is read exactly', () => {
  const model = squareModel();
  assert.equal(nodeName(model, 3), '18446744073709551615');
  assert.deepEqual([0, 1, 2].map((k) => verdictOf(model, k)), ['keep', 'prune', 'ambiguous']);
  assert.equal(stageOf(model, 1), 'refuted');
  assert.deepEqual(conflictsOf(model, 1), [0]);
  assert.deepEqual(conflictsOf(model, 0), []);
  assert.deepEqual(verdictCounts(model), [1, 1, 1]);
});

test('what is no report is refused with the reason', () => {
  const refused = (change: (document: Record<string, any>) => void, reason: RegExp) => {
    const document = squareDocument();
    change(document);
    assert.throws(() => readModel(document), reason);
  };
  assert.throws(() => readModel(null), /no report/);
  refused((d) => (d.schema = 'isotherm.prune/1'), /schema/);
  refused((d) => (d.candidates.to = i32([3, 4, 2])), /not there/);
  refused((d) => (d.trusted = i32([-1, 0])), /not there/);
  refused((d) => (d.candidates.score = f32([1])), /wrong length/);
  refused((d) => (d.layouts[0].positions = f32([1, 2, 3])), /wrong length/);
  refused((d) => (d.candidates.score = {}), /f32 is missing/);
  refused((d) => (d.layouts = []), /no layout/);
});
