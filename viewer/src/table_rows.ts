import type { Model } from './model';
import { conflictsOf, nodeName, stageOf, VERDICTS, verdictOf } from './model';
import { number } from './format';
import { exact } from './save';

/** A column of the table: how it reads and how it sorts. */
export interface TableColumn {
  key: string;
  label: string;
  help: string;
  numeric: boolean;
  text(candidate: number): string;
  /** the same with all its digits, to be saved */
  saved(candidate: number): string;
  /** negative where a comes before b */
  compare(a: number, b: number): number;
}

/** Candidates as a table has them. */
export interface TableSource {
  /** what names the files that it is saved as */
  title: string;
  edges: string;
  count: number;
  columns: TableColumn[];
  /** what rows are filtered by: their verdict */
  groups: { names: readonly string[]; of: ArrayLike<number> };
  /** texts that a search finds a candidate by */
  words(candidate: number): string[];
  /** the order at first */
  sort: string;
  descending: boolean;
}

/** What the table shows, and in which order. */
export interface TableQuery {
  text: string;
  /** groups that are shown, by number */
  groups: ReadonlySet<number>;
  sort: string;
  descending: boolean;
}

export function numeric(
  key: string,
  label: string,
  help: string,
  value: (candidate: number) => number,
  text = (candidate: number) => number(value(candidate)),
): TableColumn {
  // What is not a number goes last.
  const order = (candidate: number) => {
    const v = value(candidate);
    return Number.isNaN(v) ? Infinity : v;
  };
  const compare = (a: number, b: number) => {
    const [x, y] = [order(a), order(b)];
    return x < y ? -1 : Number(x > y);
  };
  return { key, label, help, numeric: true, text, saved: (k) => exact(value(k)), compare };
}

export function textual(
  key: string,
  label: string,
  help: string,
  text: (candidate: number) => string,
): TableColumn {
  const compare = (a: number, b: number) => text(a).localeCompare(text(b), 'en', { numeric: true });
  return { key, label, help, numeric: false, text, saved: text, compare };
}

// Vertex numbers have up to 64 bits, more than a number of the language holds.
function ends(key: string, label: string, model: Model, nodes: Int32Array): TableColumn {
  const name = (candidate: number) => model.names[nodes[candidate]];
  return {
    ...textual(key, label, `${label} ${model.nouns.node}`, (k) => nodeName(model, nodes[k])),
    numeric: !Array.isArray(model.names),
    compare: (a, b) => {
      const [x, y] = [name(a), name(b)];
      return x < y ? -1 : Number(x > y);
    },
  };
}

/** Where a candidate is in the input, and what it joins. */
export function placeColumns(model: Model): TableColumn[] {
  const { candidates } = model;
  return [
    numeric('edge', 'edge', `Position among the edges of the file`, (k) => candidates.edge[k], (k) =>
      String(candidates.edge[k]),
    ),
    ends('from', 'from', model, candidates.from),
    ends('to', 'to', model, candidates.to),
    numeric('line', 'line', 'Line of the file', (k) => candidates.line[k], (k) =>
      candidates.line[k] > 0 ? String(candidates.line[k]) : '–',
    ),
  ];
}

function tableColumns(model: Model): TableColumn[] {
  const { candidates, nouns } = model;
  const columns = [
    ...placeColumns(model),
    textual('verdict', 'verdict', `What was decided about the ${nouns.edge}`, (k) =>
      verdictOf(model, k),
    ),
    numeric('score', 'score', 'Larger is more suspicious', (k) => candidates.score[k]),
    numeric('threshold', 'threshold', 'Pruned above it', (k) => candidates.threshold[k]),
    textual('stage', 'stage', 'Round, scale or test that decided', (k) => stageOf(model, k)),
  ];
  if (candidates.conflicts) {
    columns.push(
      numeric('conflicts', 'conflicts', `Accepted ${nouns.edges} that contradict it`, (k) =>
        conflictsOf(model, k).length,
      ),
    );
  }
  for (const column of candidates.columns) {
    const unit = column.unit === '' ? '' : ` (${column.unit})`;
    columns.push(numeric(column.key, column.label + unit, column.help, (k) => column.values[k]));
  }
  return columns;
}

/** The table of all candidates of a report. */
export function tableSource(model: Model): TableSource {
  const { candidates } = model;
  return {
    title: model.title,
    edges: model.nouns.edges,
    count: candidates.count,
    columns: tableColumns(model),
    groups: { names: VERDICTS, of: candidates.verdict },
    words: (k) => [...placeWords(model, k), verdictOf(model, k), stageOf(model, k)],
    sort: 'edge',
    descending: false,
  };
}

/** Ends and number of a candidate, for searches. */
export function placeWords(model: Model, candidate: number): string[] {
  const { from, to, edge } = model.candidates;
  const ends = [from[candidate], to[candidate]].map((node) => nodeName(model, node));
  return [...ends, String(edge[candidate])];
}

function matches(source: TableSource, candidate: number, words: string[]): boolean {
  const fields = source.words(candidate).map((field) => field.toLowerCase());
  return words.every((word) =>
    // A number is a whole id, a word part of a name.
    fields.some((field) => (/^\d+$/.test(word) ? field === word : field.includes(word))),
  );
}

/** The candidates a query asks for, in its order; equal ones in order of the file. */
export function tableRows(source: TableSource, query: TableQuery): Uint32Array {
  const words = query.text.toLowerCase().split(/\s+/).filter((word) => word !== '');
  const rows: number[] = [];
  for (let k = 0; k < source.count; ++k) {
    if (!query.groups.has(source.groups.of[k])) continue;
    if (words.length === 0 || matches(source, k, words)) rows.push(k);
  }
  const column = source.columns.find(({ key }) => key === query.sort);
  if (column && !(column.key === 'edge' && !query.descending)) {
    const sign = query.descending ? -1 : 1;
    rows.sort((a, b) => sign * column.compare(a, b) || a - b);
  }
  return Uint32Array.from(rows);
}
