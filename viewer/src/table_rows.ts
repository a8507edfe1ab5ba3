import type { Model } from './model';
import { conflictsOf, nodeName, stageOf, verdictOf } from './model';
import { number } from './format';

/** A column of the table: how it reads and how it sorts. */
export interface TableColumn {
  key: string;
  label: string;
  help: string;
  numeric: boolean;
  text(candidate: number): string;
  /** negative where a comes before b */
  compare(a: number, b: number): number;
}

/** What the table shows, and in which order. */
export interface TableQuery {
  text: string;
  /** verdicts that are shown, by number */
  verdicts: ReadonlySet<number>;
  sort: string;
  descending: boolean;
}

function numeric(
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
  return { key, label, help, numeric: true, text, compare };
}

function textual(
  key: string,
  label: string,
  help: string,
  text: (candidate: number) => string,
): TableColumn {
  const compare = (a: number, b: number) => text(a).localeCompare(text(b), 'en', { numeric: true });
  return { key, label, help, numeric: false, text, compare };
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

export function tableColumns(model: Model): TableColumn[] {
  const { candidates, nouns } = model;
  const columns = [
    numeric('edge', 'edge', `Position among the edges of the file`, (k) => candidates.edge[k], (k) =>
      String(candidates.edge[k]),
    ),
    ends('from', 'from', model, candidates.from),
    ends('to', 'to', model, candidates.to),
    numeric('line', 'line', 'Line of the file', (k) => candidates.line[k], (k) =>
      candidates.line[k] > 0 ? String(candidates.line[k]) : '–',
    ),
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

function matches(model: Model, candidate: number, words: string[]): boolean {
  const { candidates } = model;
  const fields = [
    nodeName(model, candidates.from[candidate]),
    nodeName(model, candidates.to[candidate]),
    String(candidates.edge[candidate]),
    verdictOf(model, candidate),
    stageOf(model, candidate).toLowerCase(),
  ];
  return words.every((word) =>
    // A number is a whole id, a word part of a name.
    fields.some((field) => (/^\d+$/.test(word) ? field === word : field.includes(word))),
  );
}

/** The candidates a query asks for, in its order; equal ones in order of the file. */
export function tableRows(model: Model, columns: TableColumn[], query: TableQuery): Uint32Array {
  const words = query.text.toLowerCase().split(/\s+/).filter((word) => word !== '');
  const rows: number[] = [];
  for (let k = 0; k < model.candidates.count; ++k) {
    if (!query.verdicts.has(model.candidates.verdict[k])) continue;
    if (words.length === 0 || matches(model, k, words)) rows.push(k);
  }
  const column = columns.find(({ key }) => key === query.sort);
  if (column && !(column.key === 'edge' && !query.descending)) {
    const sign = query.descending ? -1 : 1;
    rows.sort((a, b) => sign * column.compare(a, b) || a - b);
  }
  return Uint32Array.from(rows);
}
