import { Buffer } from 'node:buffer';
import { type Model, readModel } from '../src/model';

function packed(type: string, values: ArrayBufferView): Record<string, string> {
  const bytes = Buffer.from(values.buffer, values.byteOffset, values.byteLength);
  return { [type]: bytes.toString('base64') };
}

export const f32 = (values: number[]) => packed('f32', Float32Array.from(values));
export const i32 = (values: number[]) => packed('i32', Int32Array.from(values));
export const u32 = (values: number[]) => packed('u32', Uint32Array.from(values));
export const u8 = (values: number[]) => packed('u8', Uint8Array.from(values));
export const u64 = (values: bigint[]) => packed('u64', BigUint64Array.from(values));

/** Four poses on a square; loop 0-3 is kept, 1-3 pruned and 0-2 ambiguous. */
export function squareDocument(): Record<string, any> {
  return {
    schema: 'isotherm.report/1',
    version: '0',
    kind: 'pose_graph',
    title: 'square.g2o',
    dimension: 2,
    unit: 'm',
    nouns: { node: 'pose', nodes: 'poses', edge: 'loop', edges: 'loops', trusted: 'odometry' },
    summary: [],
    warnings: [],
    notes: [],
    options: {},
    nodes: {
      count: 4,
      names: u64([1n, 2n, 10n, 2n ** 64n - 1n]),
      landmarks: i32([]),
      columns: [],
      path: f32([0, 1, 2, 3]),
    },
    trusted: i32([0, 1, 1, 2, 2, 3]),
    layouts: [
      { key: 'after', label: 'After', origin: [0, 0], positions: f32([0, 0, 1, 0, 1, 1, 0, 1]) },
    ],
    candidates: {
      count: 3,
      edge: u32([3, 4, 5]),
      from: i32([0, 1, 0]),
      to: i32([3, 3, 2]),
      line: u32([8, 9, 10]),
      verdict: u8([0, 1, 2]),
      score: f32([1, 100, NaN]),
      threshold: f32([10, 10, 10]),
      stage: u32([0, 1, 1]),
      stages: ['round 1', 'refuted'],
      columns: [
        { key: 'chi2', label: 'χ²', unit: '', help: '', charted: true, values: f32([2, 50, 7]) },
      ],
      conflicts: { offsets: u32([0, 0, 1, 1]), candidates: u32([0]) },
    },
    heat: { scales: [], candidates: u32([]), distances: f32([]), thresholds: [], note: '' },
    spectrum: { values: [], null_count: 0, scales: [], note: '' },
    rounds: { columns: [], rows: [] },
    truth_note: '',
  };
}

export function squareModel(): Model {
  return readModel(squareDocument());
}
