import { float32, int32, uint32, uint64, uint8 } from './packed';

export const SCHEMA = 'isotherm.report/1';

export type Kind = 'pose_graph' | 'graph' | 'network';

/** Verdicts by their number in the document. */
export const VERDICTS = ['keep', 'prune', 'ambiguous'] as const;
export type Verdict = (typeof VERDICTS)[number];

export interface Layout {
  key: string;
  label: string;
  /** nodes x dimension; NaN where not known */
  positions: Float32Array;
  /** added to positions gives coordinates of the input */
  origin: number[];
  /** the same for true positions, or null */
  truth: Float32Array | null;
  /** distance of each node from its true position, or null */
  errors: Float32Array | null;
}

export interface Column {
  key: string;
  label: string;
  unit: string;
  help: string;
  charted: boolean;
  values: Float32Array;
}

export interface Candidates {
  count: number;
  edge: Uint32Array;
  from: Int32Array;
  to: Int32Array;
  line: Uint32Array;
  verdict: Uint8Array;
  score: Float32Array;
  threshold: Float32Array;
  stage: Uint32Array;
  stages: string[];
  columns: Column[];
  conflicts: { offsets: Uint32Array; candidates: Uint32Array } | null;
}

export interface Heat {
  scales: number[];
  candidates: Uint32Array;
  /** candidates x scales */
  distances: Float32Array;
  thresholds: (number | null)[];
  note: string;
}

export interface Spectrum {
  values: number[];
  nullCount: number;
  scales: number[];
  note: string;
}

export interface Nouns {
  node: string;
  nodes: string;
  edge: string;
  edges: string;
  trusted: string;
}

/** A report as the page uses it. */
export interface Model {
  kind: Kind;
  title: string;
  version: string;
  dimension: number;
  unit: string;
  nouns: Nouns;
  summary: { heading: string; text: string }[];
  warnings: string[];
  notes: string[];
  options: Record<string, unknown>;
  nodeCount: number;
  names: BigUint64Array | string[];
  landmarks: Int32Array;
  /** whose each node is, and what they are called; null where there is but one robot */
  robots: { of: Int32Array; names: string[] } | null;
  nodeColumns: Column[];
  path: Float32Array | null;
  /** pairs of nodes */
  trusted: Int32Array;
  layouts: Layout[];
  candidates: Candidates;
  heat: Heat;
  spectrum: Spectrum;
  rounds: { columns: string[]; rows: string[][] };
  truthNote: string;
}

type Json = Record<string, any>;

function expect(condition: boolean, problem: string): void {
  if (!condition) throw new Error(problem);
}

function expectNodes(nodes: Int32Array, count: number): void {
  expect(
    nodes.every((node) => node >= 0 && node < count),
    'an edge ends at a node that is not there',
  );
}

function readColumn(json: Json, count: number): Column {
  const column = { ...json, values: float32(json.values) } as Column;
  expect(column.values.length === count, `column ${column.key} has a wrong length`);
  return column;
}

function readLayout(json: Json, size: number): Layout {
  const layout = {
    key: String(json.key),
    label: String(json.label),
    positions: float32(json.positions),
    origin: (json.origin as unknown[]).map(Number),
    truth: json.truth ? float32(json.truth) : null,
    errors: json.errors ? float32(json.errors) : null,
  };
  expect(layout.positions.length === size, `layout ${layout.key} has a wrong length`);
  expect(!layout.truth || layout.truth.length === size, 'the truth has a wrong length');
  return layout;
}

function readCandidates(json: Json, nodeCount: number): Candidates {
  const count = Number(json.count);
  const all: Candidates = {
    count,
    edge: uint32(json.edge),
    from: int32(json.from),
    to: int32(json.to),
    line: uint32(json.line),
    verdict: uint8(json.verdict),
    score: float32(json.score),
    threshold: float32(json.threshold),
    stage: uint32(json.stage),
    stages: (json.stages as unknown[]).map(String),
    columns: (json.columns as Json[]).map((column) => readColumn(column, count)),
    conflicts: json.conflicts
      ? {
          offsets: uint32(json.conflicts.offsets),
          candidates: uint32(json.conflicts.candidates),
        }
      : null,
  };
  for (const values of [all.edge, all.from, all.to, all.line, all.verdict, all.score, all.stage]) {
    expect(values.length === count, 'a column of candidates has a wrong length');
  }
  expectNodes(all.from, nodeCount);
  expectNodes(all.to, nodeCount);
  return all;
}

function readRobots(json: Json | undefined, nodeCount: number): Model['robots'] {
  if (!json) return null;
  const robots = { of: int32(json.of), names: (json.names as unknown[]).map(String) };
  expect(robots.of.length === nodeCount, 'the robots of nodes have a wrong length');
  expect(
    robots.of.every((robot) => robot >= 0 && robot < robots.names.length),
    'a node is of a robot that is not there',
  );
  return robots;
}

/**
 * The report in a parsed document.
 * Throws an Error that says what is wrong with a document of another kind.
 */
export function readModel(json: Json | null): Model {
  expect(json !== null && typeof json === 'object', 'the page holds no report');
  const from = json as Json;
  expect(from.schema === SCHEMA, `the document is not of schema ${SCHEMA}`);
  const nodeCount = Number(from.nodes.count);
  const dimension = Number(from.dimension);
  const trusted = int32(from.trusted);
  expectNodes(trusted, nodeCount);
  const names = Array.isArray(from.nodes.names)
    ? (from.nodes.names as unknown[]).map(String)
    : uint64(from.nodes.names);
  expect(names.length === nodeCount, 'the names of nodes have a wrong length');
  const layouts = (from.layouts as Json[]).map((l) => readLayout(l, nodeCount * dimension));
  expect(layouts.length > 0, 'the report has no layout');
  return {
    kind: from.kind,
    title: String(from.title),
    version: String(from.version),
    dimension,
    unit: String(from.unit),
    nouns: from.nouns,
    summary: from.summary,
    warnings: from.warnings,
    notes: from.notes,
    options: from.options,
    nodeCount,
    names,
    landmarks: int32(from.nodes.landmarks),
    robots: readRobots(from.nodes.robots, nodeCount),
    nodeColumns: (from.nodes.columns as Json[]).map((column) => readColumn(column, nodeCount)),
    path: from.nodes.path ? float32(from.nodes.path) : null,
    trusted,
    layouts,
    candidates: readCandidates(from.candidates, nodeCount),
    heat: {
      ...from.heat,
      candidates: uint32(from.heat.candidates),
      distances: float32(from.heat.distances),
    },
    spectrum: { ...from.spectrum, nullCount: from.spectrum.null_count },
    rounds: from.rounds,
    truthNote: String(from.truth_note),
  };
}

/** What the input calls a node. */
export function nodeName(model: Model, node: number): string {
  return String(model.names[node]);
}

export function verdictOf(model: Model, candidate: number): Verdict {
  return VERDICTS[model.candidates.verdict[candidate]] ?? 'ambiguous';
}

export function stageOf(model: Model, candidate: number): string {
  return model.candidates.stages[model.candidates.stage[candidate]] ?? '';
}

/** Candidates that contradict this one. */
export function conflictsOf(model: Model, candidate: number): number[] {
  const conflicts = model.candidates.conflicts;
  if (!conflicts) return [];
  return Array.from(
    conflicts.candidates.subarray(conflicts.offsets[candidate], conflicts.offsets[candidate + 1]),
  );
}

/** Candidates that this one contradicts: the other way from conflictsOf(). */
export function contradictedBy(model: Model, candidate: number): number[] {
  const conflicts = model.candidates.conflicts;
  const found: number[] = [];
  if (!conflicts) return found;
  for (let k = 0, row = 0; k < conflicts.candidates.length; ++k) {
    while (conflicts.offsets[row + 1] <= k) ++row;
    if (conflicts.candidates[k] === candidate) found.push(row);
  }
  return found;
}

/** The ends of a candidate, as the input calls them. */
export function candidateName(model: Model, candidate: number): string {
  const { from, to } = model.candidates;
  return `${nodeName(model, from[candidate])} – ${nodeName(model, to[candidate])}`;
}

/** Candidates in order of the input. */
export function inOrder(model: Model): Uint32Array {
  return Uint32Array.from({ length: model.candidates.count }, (_, k) => k);
}

/** How many candidates have each verdict, in the order of VERDICTS. */
export function verdictCounts(model: Model): number[] {
  const counts = VERDICTS.map(() => 0);
  for (const verdict of model.candidates.verdict) ++counts[verdict];
  return counts;
}
