import type { Model } from './model';
import { readModel, stageOf, VERDICTS, verdictOf } from './model';
import type { TableColumn, TableSource } from './table_rows';
import { numeric, placeColumns, placeWords, textual } from './table_rows';

export const COMPARISON_SCHEMA = 'isotherm.comparison/1';

/** Two reports on one graph: the same candidates, judged twice. */
export interface Comparison {
  names: [string, string];
  models: [Model, Model];
}

type Json = Record<string, any>;

/**
 * The comparison in a parsed document.
 * Throws an Error where the two reports are not on one graph.
 */
export function readComparison(json: Json): Comparison {
  const models = (json.reports as Json[]).map(readModel);
  const names = (json.names as unknown[]).map(String);
  if (models.length !== 2 || names.length !== 2) throw new Error('a comparison has two reports');
  const [a, b] = models.map(({ candidates }) => candidates);
  const same = (x: ArrayLike<number>, y: ArrayLike<number>) =>
    x.length === y.length && Array.from(x).every((value, k) => value === y[k]);
  if (!same(a.edge, b.edge) || !same(a.from, b.from) || !same(a.to, b.to)) {
    throw new Error('the two reports are not on one graph');
  }
  return { names, models } as Comparison;
}

/** 0 for each candidate that both decided alike, else 1. */
export function differences({ models }: Comparison): Uint8Array {
  const [a, b] = models.map(({ candidates }) => candidates.verdict);
  return a.map((verdict, k) => Number(verdict !== b[k]));
}

/** How many candidates got which two verdicts: a row for each of the first report. */
export function agreement({ models }: Comparison): number[][] {
  const [a, b] = models.map(({ candidates }) => candidates.verdict);
  const table = VERDICTS.map(() => VERDICTS.map(() => 0));
  a.forEach((verdict, k) => ++table[verdict][b[k]]);
  return table;
}

/** All candidates, those with different verdicts first. */
export function differentFirst(comparison: Comparison): Uint32Array {
  const order = [...differences(comparison).entries()];
  return Uint32Array.from(order.sort((a, b) => b[1] - a[1] || a[0] - b[0]).map(([k]) => k));
}

// What one of the two says about a candidate.
function sideColumns(model: Model, side: string, name: string): TableColumn[] {
  const { candidates } = model;
  const head = (label: string) => `${label} ${side.toUpperCase()}`;
  return [
    textual(`verdict-${side}`, head('verdict'), `What ${name} decided`, (k) => verdictOf(model, k)),
    numeric(`score-${side}`, head('score'), `Score of ${name}`, (k) => candidates.score[k]),
    textual(`stage-${side}`, head('stage'), `What decided in ${name}`, (k) => stageOf(model, k)),
  ];
}

/** The table of both, those with different verdicts first. */
export function comparisonSource(comparison: Comparison): TableSource {
  const { names, models } = comparison;
  const [a, b] = models;
  const differ = differences(comparison);
  const words = (model: Model, k: number) => [verdictOf(model, k), stageOf(model, k)];
  const isDifferent = textual('differs', 'verdicts', 'Whether both decided alike', (k) =>
    differ[k] === 1 ? 'differ' : 'agree',
  );
  const sides = [sideColumns(a, 'a', names[0]), sideColumns(b, 'b', names[1])];
  return {
    title: `${a.title}-${names.join('-')}`,
    edges: a.nouns.edges,
    count: a.candidates.count,
    columns: [...placeColumns(a), isDifferent, ...sides[0], ...sides[1]],
    groups: { names: ['agree', 'differ'], of: differ },
    words: (k) => [...placeWords(a, k), ...words(a, k), ...words(b, k)],
    sort: 'differs',
    descending: true,
  };
}
