/** What the parts of the page share: the chosen candidate and the visible layers. */
export interface State {
  /** chosen candidate, or -1 */
  selected: number;
  /** layers that are not drawn */
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

  toggleLayer(key: string, visible: boolean): void {
    const hidden = new Set(this.state.hidden);
    if (visible) hidden.delete(key);
    else hidden.add(key);
    this.update({ hidden });
  }
}
