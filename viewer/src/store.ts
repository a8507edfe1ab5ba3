/** What the parts of the page share: the chosen candidate and the visible layers. */
export interface State {
  /** chosen candidate, or -1 */
  selected: number;
  /** layers that are not drawn, anywhere or, as `after:prune`, in one layout */
  hidden: ReadonlySet<string>;
  theme: 'light' | 'dark';
}

type Listener = (state: State, before: State) => void;

/** Holds the state and tells everyone who asked when it changes. */
export class Store {
  private listeners: Listener[] = [];

  constructor(public state: State) {}

  subscribe(listener: Listener): void {
    this.listeners.push(listener);
  }

  update(change: Partial<State>): void {
    const before = this.state;
    this.state = { ...before, ...change };
    for (const listener of this.listeners) listener(this.state, before);
  }

  select(candidate: number): void {
    if (candidate !== this.state.selected) this.update({ selected: candidate });
  }

  /** The next or the previous candidate of `order`, from the last to the first and back. */
  step(by: number, order: Uint32Array): void {
    if (order.length === 0) return;
    const now = order.indexOf(this.state.selected);
    const start = now < 0 && by < 0 ? 0 : now;
    this.select(order[(start + by + order.length) % order.length]);
  }

  toggleLayer(key: string, visible: boolean): void {
    const hidden = new Set(this.state.hidden);
    if (visible) hidden.delete(key);
    else hidden.add(key);
    this.update({ hidden });
  }
}
