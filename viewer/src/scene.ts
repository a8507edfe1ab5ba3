import { count } from './format';
import type { Layout, Model } from './model';
import { VERDICTS, verdictCounts } from './model';

/** One kind of thing on the map, drawn and toggled together. */
export interface DrawLayer {
  key: string;
  /** three numbers a node */
  positions: Float32Array;
  /** pairs of nodes joined by lines; empty for a layer of points */
  lines: Uint32Array;
  /** nodes drawn as points */
  points: Uint32Array;
  /** candidate of each line, where lines can be chosen */
  candidates: Uint32Array | null;
  /** CSS variable with the colour */
  colour: string;
  width: number;
  opacity: number;
  /** pixels drawn and left out in turn, or null for solid lines */
  dash: [number, number] | null;
}

/** A layer's name, sign and size, as the legend shows it. */
export interface LegendEntry {
  key: string;
  label: string;
  /** one a report */
  counts: number[];
  colour: string;
  shape: 'line' | 'point';
}

/** What is drawn of a layout, and what is not. */
export interface Scene {
  layers: DrawLayer[];
  /** sentences that say what was thinned */
  notes: string[];
}

const COLOURS: Record<string, string> = {
  trusted: '--trusted',
  keep: '--keep',
  prune: '--prune',
  ambiguous: '--ambiguous',
  truth: '--truth',
  band: '--truth-band',
  nodes: '--node',
  landmarks: '--landmark',
};

// Verdicts are told apart without their colours, too.
const DASHES: Record<string, [number, number]> = { prune: [8, 4], ambiguous: [2, 3] };

/** Three numbers a node whatever the dimension. */
export function inSpace(positions: Float32Array, dimension: number): Float32Array {
  if (dimension === 3) return positions;
  const nodes = dimension > 0 ? positions.length / dimension : 0;
  const space = new Float32Array(3 * nodes);
  for (let k = 0; k < nodes; ++k) {
    for (let d = 0; d < dimension; ++d) space[3 * k + d] = positions[dimension * k + d];
  }
  return space;
}

/** `limit` of the positions below `size`, evenly spread; all if there are no more. */
export function thinned(size: number, limit: number): Uint32Array {
  const kept = Math.min(size, limit);
  const chosen = new Uint32Array(kept);
  for (let k = 0; k < kept; ++k) chosen[k] = Math.floor((k * size) / kept);
  return chosen;
}

/**
 * Pairs of nodes that are joined, at most about `limit`: where there are more, runs of pairs
 * that follow each other are drawn as one.
 */
export function joined(pairs: Int32Array, limit: number): Int32Array {
  const size = pairs.length / 2;
  if (size <= limit) return pairs;
  const stride = Math.ceil(size / limit);
  const lines: number[] = [];
  for (let k = 0; k < size; ) {
    let end = k + 1;
    while (end < size && end < k + stride && pairs[2 * end] === pairs[2 * end - 1]) ++end;
    lines.push(pairs[2 * k], pairs[2 * end - 1]);
    k = end;
  }
  return Int32Array.from(lines);
}

function isKnown(positions: Float32Array, node: number): boolean {
  return Number.isFinite(
    positions[3 * node] + positions[3 * node + 1] + positions[3 * node + 2],
  );
}

/** Pairs of nodes as lines, without those whose ends are not known. */
function linesOf(
  positions: Float32Array,
  size: number,
  ends: (k: number) => [number, number],
): { lines: Uint32Array; sources: Uint32Array } {
  const lines = new Uint32Array(2 * size);
  const sources = new Uint32Array(size);
  let used = 0;
  for (let k = 0; k < size; ++k) {
    const [from, to] = ends(k);
    if (!isKnown(positions, from) || !isKnown(positions, to)) continue;
    lines[2 * used] = from;
    lines[2 * used + 1] = to;
    sources[used++] = k;
  }
  return { lines: lines.subarray(0, 2 * used), sources: sources.subarray(0, used) };
}

/** Many lines over each other should still let the map show through. */
function opacityOf(lines: number): number {
  if (lines > 5000) return 0.25;
  return lines > 300 ? 0.45 : 0.85;
}

/** Many dots are small, so that what joins them is seen. */
function dotSize(dots: number): number {
  if (dots > 1500) return 2;
  return dots > 400 ? 3 : 5;
}

const AFTERWARDS = 0.4;
/** Lines of a path, and nodes, for each candidate of a verdict that may be drawn. */
const PATH = 2;

/** Pieces of a broad path: as many as are drawn broad. */
const BAND = 4000;

const NO_LINES = new Uint32Array(0);

class SceneBuilder {
  readonly layers: DrawLayer[] = [];
  readonly notes: string[] = [];
  private readonly positions: Float32Array;
  // What was left out of a pose graph has no place in the map that it did not bend.
  private readonly fading: number;

  constructor(
    private readonly model: Model,
    private readonly layout: Layout,
    private readonly limit: number,
  ) {
    this.positions = inSpace(layout.positions, model.dimension);
    this.fading = layout.key === 'after' && model.kind === 'pose_graph' ? AFTERWARDS : 1;
  }

  addCandidates(verdict: number): void {
    const { candidates, nouns } = this.model;
    const key = VERDICTS[verdict];
    const all: number[] = [];
    candidates.verdict.forEach((v, k) => {
      if (v === verdict) all.push(k);
    });
    const chosen = thinned(all.length, this.limit);
    const { lines, sources } = linesOf(this.positions, chosen.length, (k) => {
      const candidate = all[chosen[k]];
      return [candidates.from[candidate], candidates.to[candidate]];
    });
    this.noteThinning(chosen.length, all.length, `${label(key)} ${nouns.edges}`);
    this.add(key, {
      lines,
      candidates: sources.map((k) => all[chosen[k]]),
      width: 1.5,
      dash: DASHES[key] ?? null,
      opacity: key === 'keep' ? 0.9 : opacityOf(chosen.length) * this.fading,
    });
  }

  addTrusted(): void {
    trustedOf(this.model).forEach(({ key, pairs, colour }) => this.addPath(key, pairs, colour));
  }

  private addPath(key: string, all: Int32Array, colour: string): void {
    const pairs = joined(all, PATH * this.limit);
    const size = all.length / 2;
    if (pairs.length < 2 * size) {
      this.notes.push(
        `Drawn: ${count(pairs.length / 2)} straight lines in place of ${count(size)} ` +
          `${this.model.nouns.trusted} edges.`,
      );
    }
    const { lines } = linesOf(this.positions, pairs.length / 2, (k) => [
      pairs[2 * k],
      pairs[2 * k + 1],
    ]);
    this.add(key, { lines, colour, width: 1.5, opacity: 0.9 });
  }

  /** The true path of a pose graph; elsewhere a line from each node to where it belongs. */
  addTruth(): void {
    if (!this.layout.truth) return;
    const truth = inSpace(this.layout.truth, this.model.dimension);
    if (this.model.kind === 'pose_graph') {
      const stops = thinned(this.model.nodeCount, Math.min(BAND, PATH * this.limit));
      const steps = Math.max(stops.length - 1, 0);
      const { lines } = linesOf(truth, steps, (k) => [stops[k], stops[k + 1]]);
      // Opaque: short pieces of a path lie over each other's ends.
      this.add('truth', { positions: truth, lines, width: 5, opacity: 1, colour: COLOURS.band });
      return;
    }
    const both = new Float32Array(2 * truth.length);
    both.set(this.positions);
    both.set(truth, truth.length);
    const nodes = this.model.nodeCount;
    const { lines } = linesOf(both, nodes, (k) => [k, nodes + k]);
    this.add('truth', { positions: both, lines, width: 2, opacity: 0.9 });
  }

  addNodes(): void {
    if (this.model.kind === 'pose_graph') return;
    const landmarks = new Set(this.model.landmarks);
    const moving = [...Array(this.model.nodeCount).keys()].filter(
      (k) => !landmarks.has(k) && isKnown(this.positions, k),
    );
    const chosen = thinned(moving.length, PATH * this.limit);
    this.noteThinning(chosen.length, moving.length, this.model.nouns.nodes);
    this.add('nodes', { points: chosen.map((k) => moving[k]), width: dotSize(moving.length), opacity: 1 });
  }

  addLandmarks(): void {
    if (this.model.kind === 'pose_graph') return;
    const fixed = this.model.landmarks.filter((k) => isKnown(this.positions, k));
    this.add('landmarks', { points: Uint32Array.from(fixed), width: 10, opacity: 1 });
  }

  private add(key: string, layer: Partial<DrawLayer>): void {
    this.layers.push({
      key,
      positions: this.positions,
      lines: NO_LINES,
      points: NO_LINES,
      candidates: null,
      colour: COLOURS[key],
      width: 1,
      opacity: 1,
      dash: null,
      ...layer,
    });
  }

  private noteThinning(drawn: number, size: number, what: string): void {
    if (drawn < size) {
      this.notes.push(`Drawn: ${count(drawn)} of ${count(size)} ${what}; the table has all.`);
    }
  }
}

function label(key: string): string {
  return { keep: 'kept', prune: 'pruned', ambiguous: 'ambiguous' }[key] ?? key;
}

const ROBOT_COLOURS = 6;

/** The trusted edges of each robot, with a colour of its own; of all, where there is but one. */
function trustedOf(
  model: Model,
): { key: string; label: string; pairs: Int32Array; colour: string }[] {
  const { robots, trusted, nouns } = model;
  if (!robots) {
    return [{ key: 'trusted', label: nouns.trusted, pairs: trusted, colour: COLOURS.trusted }];
  }
  const pairs: number[][] = robots.names.map(() => []);
  for (let k = 0; k < trusted.length; k += 2) {
    pairs[robots.of[trusted[k]]].push(trusted[k], trusted[k + 1]);
  }
  return robots.names.map((name, robot) => ({
    key: `trusted-${robot}`,
    label: `${nouns.trusted} of ${name}`,
    pairs: Int32Array.from(pairs[robot]),
    colour: `--robot-${1 + (robot % ROBOT_COLOURS)}`,
  }));
}

/** The layers of a layout, undermost first; at most `limit` candidates a verdict. */
export function buildScene(model: Model, layout: Layout, limit: number): Scene {
  const builder = new SceneBuilder(model, layout, limit);
  if (model.kind === 'pose_graph') {
    // The truth lies below the estimate, as a broad band that shows on both sides of it.
    builder.addCandidates(1);
    builder.addCandidates(2);
    builder.addTruth();
    builder.addTrusted();
    builder.addCandidates(0);
  } else {
    // Nodes do not cover edges, nor do the many that are kept cover those that are not.
    builder.addNodes();
    builder.addTrusted();
    builder.addCandidates(0);
    builder.addCandidates(2);
    builder.addCandidates(1);
    builder.addTruth();
    builder.addLandmarks();
  }
  return { layers: builder.layers, notes: builder.notes };
}

/**
 * What there is on the maps of reports on one graph, in the order in which people ask for it;
 * what there is nothing of is left out.
 */
export function legendOf(models: Model[]): LegendEntry[] {
  const model = models[0];
  const entries: LegendEntry[] = [];
  VERDICTS.forEach((key, verdict) => {
    const counts = models.map((one) => verdictCounts(one)[verdict]);
    if (counts.every((size) => size === 0)) return;
    const text = `${label(key)} ${model.nouns.edges}`;
    entries.push({ key, label: text, counts, colour: COLOURS[key], shape: 'line' });
  });
  const add = (
    key: string,
    text: string,
    size: number,
    shape: 'line' | 'point',
    colour = COLOURS[key],
  ) => {
    if (size > 0) entries.push({ key, label: text, counts: [size], colour, shape });
  };
  for (const { key, label: text, pairs, colour } of trustedOf(model)) {
    const size = pairs.length / 2;
    if (size > 0) entries.push({ key, label: text, counts: [size], colour, shape: 'line' });
  }
  const truth = model.layouts.find((layout) => layout.errors)?.errors;
  if (truth) {
    const known = truth.reduce((sum, error) => sum + Number(!Number.isNaN(error)), 0);
    if (model.kind === 'pose_graph') add('truth', 'ground truth', known, 'line', COLOURS.band);
    else add('truth', 'to true position', known, 'line');
  }
  if (model.kind !== 'pose_graph') {
    add('nodes', model.nouns.nodes, model.nodeCount - model.landmarks.length, 'point');
    add('landmarks', 'anchors', model.landmarks.length, 'point');
  }
  return entries;
}
