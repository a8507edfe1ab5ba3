import type { State, Store } from './store';

const ROOT = document.documentElement;

/** What the system prefers. */
export function preferredTheme(): State['theme'] {
  return matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light';
}

/** The value of a CSS variable as it is now. */
export function colour(variable: string): string {
  return getComputedStyle(ROOT).getPropertyValue(variable).trim();
}

/** Follows the store's theme, and prints in light colours whatever the theme is. */
export function followTheme(store: Store): void {
  const apply = (theme: State['theme']) => ROOT.setAttribute('data-theme', theme);
  apply(store.state.theme);
  // First of all listeners, so that others read the new colours.
  store.subscribe((state) => apply(state.theme));
  let before = store.state.theme;
  addEventListener('beforeprint', () => {
    before = store.state.theme;
    store.update({ theme: 'light' });
  });
  addEventListener('afterprint', () => store.update({ theme: before }));
}
