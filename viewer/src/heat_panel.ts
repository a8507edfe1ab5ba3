import { Chart } from './chart';
import type { ChartSeries } from './chart_spec';
import { absent, html, panel } from './dom';
import type { Model } from './model';
import { candidateName, VERDICTS } from './model';
import type { Store } from './store';

function row(model: Model, position: number): Float32Array {
  const width = model.heat.scales.length;
  return model.heat.distances.subarray(position * width, (position + 1) * width);
}

/** The median over the candidates with a verdict, a value a scale; null without any. */
export function medianDistances(model: Model, verdict: number): number[] | null {
  const { heat, candidates } = model;
  const chosen = [...heat.candidates.keys()].filter(
    (k) => candidates.verdict[heat.candidates[k]] === verdict,
  );
  if (chosen.length === 0) return null;
  return heat.scales.map((_, scale) => {
    const values = chosen.map((k) => row(model, k)[scale]).sort((a, b) => a - b);
    return values[values.length >> 1];
  });
}

/** How far apart the ends of the chosen candidate are at every scale. */
export function heatPanel(model: Model, store: Store): HTMLElement {
  const { heat, nouns } = model;
  const title = 'Heat distance against scale';
  if (heat.candidates.length === 0) {
    return panel('heat', title, absent(`There are no ${nouns.edges}.`));
  }
  // uPlot wants ascending abscissae; scales come from global to local.
  const order = [...heat.scales.keys()].sort((a, b) => heat.scales[a] - heat.scales[b]);
  const inOrder = (values: ArrayLike<number | null>) => order.map((k) => values[k]);
  const backdrop: ChartSeries[] = VERDICTS.flatMap((name, verdict) => {
    const medians = medianDistances(model, verdict);
    if (!medians) return [];
    return {
      label: `median ${name}`,
      colour: `--${name}`,
      kind: 'line' as const,
      dash: [[], [6, 4], [2, 3]][verdict],
      values: inOrder(medians),
    };
  });
  if (heat.thresholds.length > 0) {
    const values = inOrder(heat.thresholds);
    backdrop.push({ label: 'threshold', colour: '--ink-soft', kind: 'points', values });
  }
  const positions = new Map([...heat.candidates].map((candidate, k) => [candidate, k]));
  const drawn = new Chart(model.title, 'heat', store);
  const note = html('p', { class: 'note', 'aria-live': 'polite' });
  const show = (candidate: number) => {
    const position = positions.get(candidate);
    const series = [...backdrop];
    if (position !== undefined) {
      const names = candidateName(model, candidate);
      const values = inOrder(Array.from(row(model, position)));
      series.push({ label: names, colour: '--selected', kind: 'dotted-line', values });
    }
    const missing = candidate >= 0 && position === undefined;
    note.textContent =
      heat.note + (missing ? ` The chosen ${nouns.edge} is not among those computed.` : '');
    drawn.show({
      description: `Squared heat distance at ${heat.scales.length} scales`,
      x: { label: 'diffusion time t', log: true },
      y: { label: 'squared heat distance', range: [0, 2] },
      xs: order.map((k) => heat.scales[k]),
      series,
    });
  };
  store.subscribe((state, before) => {
    if (state.selected !== before.selected) show(state.selected);
  });
  show(store.state.selected);
  return panel('heat', title, drawn.element, note);
}
