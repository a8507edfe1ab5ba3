import { absent, html, panel } from './dom';
import { capital, count } from './format';
import { saveButtons } from './save';
import type { Store } from './store';
import type { TableColumn, TableQuery, TableSource } from './table_rows';
import { tableRows } from './table_rows';

const ROW_HEIGHT = 28;
const MARGIN_ROWS = 6;
const PRINTED_ROWS = 100;

/** A table that keeps only the rows in sight in the page, however many there are. */
class CandidateTable {
  readonly element: HTMLElement;
  private readonly columns: TableColumn[];
  private readonly heads = new Map<string, HTMLElement>();
  private readonly body = html('div', { class: 'rows', role: 'rowgroup' });
  private readonly grid: HTMLElement;
  private readonly status = html('p', { class: 'note', role: 'status' });
  private query: TableQuery;
  private rows: Uint32Array = new Uint32Array(0);
  private printing = false;

  constructor(
    private readonly source: TableSource,
    private readonly store: Store,
  ) {
    const { columns, groups, sort, descending } = source;
    this.columns = columns;
    this.query = { text: '', groups: new Set(groups.names.keys()), sort, descending };
    this.grid = html(
      'div',
      {
        class: 'grid',
        role: 'grid',
        tabindex: 0,
        'aria-label': `${capital(source.edges)}; arrow keys choose one`,
        'aria-colcount': this.columns.length,
      },
      this.head(),
      this.body,
    );
    const buttons = saveButtons(source.title, 'table', { csv: () => this.saved() });
    this.element = html('div', { class: 'saved' }, buttons, this.filters(), this.status, this.grid);
    this.listen();
    this.refresh();
  }

  /** The rows that the filters leave, in their order. */
  private saved(): string[][] {
    const rows = Array.from(this.rows, (k) => this.columns.map((column) => column.saved(k)));
    return [this.columns.map(({ label }) => label), ...rows];
  }

  private head(): HTMLElement {
    const cells = this.columns.map((column) => {
      const button = html('button', { type: 'button', title: column.help }, column.label);
      button.addEventListener('click', () => this.sortBy(column.key));
      const kind = column.numeric ? 'number' : 'text';
      const cell = html('div', { role: 'columnheader', class: `cell ${kind} col-${column.key}` }, button);
      this.heads.set(column.key, cell);
      return cell;
    });
    return html('div', { class: 'head row', role: 'row', 'aria-rowindex': 1 }, ...cells);
  }

  private filters(): HTMLElement {
    const search = html('input', {
      type: 'search',
      placeholder: `id, verdict or stage`,
      'aria-label': `Filter ${this.source.edges} by id, verdict or stage`,
      'data-filter': 'text',
    });
    search.addEventListener('input', () => this.ask({ text: search.value }));
    const { groups, count: size } = this.source;
    const counts = groups.names.map(() => 0);
    for (let k = 0; k < size; ++k) ++counts[groups.of[k]];
    const boxes = groups.names.map((name, group) => {
      const box = html('input', { type: 'checkbox', checked: true, 'data-filter': name });
      box.addEventListener('change', () => {
        const shown = new Set(this.query.groups);
        if (box.checked) shown.add(group);
        else shown.delete(group);
        this.ask({ groups: shown });
      });
      return html('label', { class: 'layer' }, box, `${name} (${count(counts[group])})`);
    });
    return html('div', { class: 'filters', role: 'search' }, search, ...boxes);
  }

  private listen(): void {
    this.grid.addEventListener('scroll', () => this.draw());
    this.grid.addEventListener('keydown', (event) => {
      if (event.target === this.grid && this.press(event.key)) event.preventDefault();
    });
    this.body.addEventListener('click', (event) => {
      const row = (event.target as HTMLElement).closest<HTMLElement>('[data-candidate]');
      if (row) this.store.select(Number(row.dataset.candidate));
    });
    this.store.subscribe((state, before) => {
      if (state.selected === before.selected) return;
      this.reveal(state.selected);
      this.draw();
    });
    new ResizeObserver(() => this.draw()).observe(this.grid);
    addEventListener('beforeprint', () => this.print(true));
    addEventListener('afterprint', () => this.print(false));
  }

  private press(key: string): boolean {
    const last = this.rows.length - 1;
    if (last < 0) return false;
    const now = this.rows.indexOf(this.store.state.selected);
    const page = Math.max(Math.floor(this.grid.clientHeight / ROW_HEIGHT) - 2, 1);
    const moves: Record<string, number> = {
      ArrowDown: now + 1,
      ArrowUp: now < 0 ? last : now - 1,
      PageDown: now + page,
      PageUp: now - page,
      Home: 0,
      End: last,
    };
    if (key === 'Escape') this.store.select(-1);
    const next = moves[key];
    if (next === undefined) return key === 'Escape';
    this.store.select(this.rows[Math.max(0, Math.min(last, next))]);
    return true;
  }

  private sortBy(key: string): void {
    this.ask({ sort: key, descending: this.query.sort === key && !this.query.descending });
  }

  private ask(change: Partial<TableQuery>): void {
    this.query = { ...this.query, ...change };
    this.refresh();
  }

  private refresh(): void {
    this.rows = tableRows(this.source, this.query);
    for (const [key, cell] of this.heads) {
      const direction = this.query.descending ? 'descending' : 'ascending';
      cell.setAttribute('aria-sort', key === this.query.sort ? direction : 'none');
    }
    this.grid.setAttribute('aria-rowcount', String(this.rows.length + 1));
    this.status.textContent =
      `${count(this.rows.length)} of ${count(this.source.count)} ${this.source.edges}`;
    this.reveal(this.store.state.selected);
    this.draw();
  }

  /** Scrolls to a candidate, if it is among the rows. */
  private reveal(candidate: number): void {
    const position = this.rows.indexOf(candidate);
    if (candidate < 0 || position < 0) return;
    const top = position * ROW_HEIGHT;
    const room = this.grid.clientHeight - 2 * ROW_HEIGHT;
    if (top < this.grid.scrollTop || top > this.grid.scrollTop + room) {
      this.grid.scrollTop = top - room / 2;
    }
  }

  private print(on: boolean): void {
    this.printing = on;
    this.draw();
  }

  private draw(): void {
    const sight = this.printing
      ? [0, PRINTED_ROWS]
      : [
          Math.floor(this.grid.scrollTop / ROW_HEIGHT) - MARGIN_ROWS,
          Math.ceil((this.grid.scrollTop + this.grid.clientHeight) / ROW_HEIGHT) + MARGIN_ROWS,
        ];
    const first = Math.max(0, sight[0]);
    const end = Math.min(this.rows.length, sight[1]);
    this.body.replaceChildren();
    for (let k = first; k < end; ++k) this.body.append(this.row(k));
    const shown = this.printing ? end : this.rows.length;
    this.body.style.height = `${shown * ROW_HEIGHT}px`;
    const { selected } = this.store.state;
    if (selected >= 0) this.grid.setAttribute('aria-activedescendant', `row-${selected}`);
    else this.grid.removeAttribute('aria-activedescendant');
  }

  private row(position: number): HTMLElement {
    const candidate = this.rows[position];
    const chosen = candidate === this.store.state.selected;
    const cells = this.columns.map((column) => {
      const isVerdict = column.key.startsWith('verdict');
      const extra = isVerdict ? ` verdict verdict-${column.text(candidate)}` : '';
      const kind = column.numeric ? 'number' : 'text';
      return html(
        'div',
        { role: 'gridcell', class: `cell ${kind} col-${column.key}` },
        html('span', { class: extra.trim() || undefined }, column.text(candidate)),
      );
    });
    const row = html(
      'div',
      {
        class: chosen ? 'row chosen' : 'row',
        role: 'row',
        id: `row-${candidate}`,
        'aria-rowindex': position + 2,
        'aria-selected': String(chosen),
        'data-candidate': candidate,
      },
      ...cells,
    );
    row.style.top = `${position * ROW_HEIGHT}px`;
    return row;
  }
}

/** All candidates, to sort, filter, choose and save. */
export function tablePanel(source: TableSource, store: Store): HTMLElement {
  const { edges } = source;
  if (source.count === 0) {
    return panel('table', capital(edges), absent(`The input has no ${edges} to decide on.`));
  }
  return panel(
    'table',
    capital(edges),
    new CandidateTable(source, store).element,
    html('p', { class: 'note print-only' }, `Printed: the first ${PRINTED_ROWS} rows.`),
  );
}
