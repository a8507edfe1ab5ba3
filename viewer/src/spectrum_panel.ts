import { chart } from './chart';
import { absent, html, panel } from './dom';
import { number } from './format';
import type { Model } from './model';
import type { Store } from './store';

/** What is drawn for an eigenvalue of 0, or so close to it that its logarithm says nothing. */
const FLOOR = 1e-12;

const CURVES = ['--series-1', '--series-2', '--series-3', '--series-4', '--series-5', '--series-6', '--series-7'];
const DASHES = [[], [8, 3], [2, 3]];

/** The smallest eigenvalues of the Laplacian, null ones left out. */
export function spectrumPanel(model: Model, store: Store): HTMLElement {
  const { values, nullCount, note } = model.spectrum;
  const title = 'Spectrum of the Laplacian';
  const positive = values.slice(nullCount);
  if (positive.length === 0) {
    return panel('spectrum', title, absent(`There are no eigenvalues above 0. ${note}`));
  }
  return panel(
    'spectrum',
    title,
    chart(
      model.title,
      'spectrum',
      {
        description: `${positive.length} eigenvalues from ${number(positive[0])}`,
        x: { label: 'number k of the eigenvalue' },
        y: { label: 'eigenvalue λ', log: true },
        xs: positive.map((_, k) => k + nullCount + 1),
        series: [
          {
            label: 'λ',
            colour: '--keep',
            kind: 'dotted-line',
            values: positive.map((v) => Math.max(v, FLOOR)),
          },
        ],
      },
      store,
    ),
    html('p', { class: 'note' }, note),
  );
}

/** How fast heat forgets each eigenvector: exp(-lambda t). */
export function decayPanel(model: Model, store: Store): HTMLElement {
  const { values, scales } = model.spectrum;
  const title = 'Heat kernel exp(−λt)';
  if (values.length === 0) {
    return panel('decay', title, absent('There are no eigenvalues.'));
  }
  return panel(
    'decay',
    title,
    chart(
      model.title,
      'decay',
      {
        description: `exp(-lambda t) of ${values.length} eigenvalues at ${scales.length} times`,
        x: { label: 'number k of the eigenvalue' },
        y: { label: 'exp(−λt)', range: [0, 1.02] },
        xs: values.map((_, k) => k + 1),
        series: scales.map((t, k) => ({
          label: `t = ${number(t)}`,
          colour: CURVES[k % CURVES.length],
          kind: 'line',
          dash: DASHES[k % DASHES.length],
          values: values.map((v) => Math.exp(-Math.max(v, 0) * t)),
        })),
      },
      store,
    ),
    html('p', { class: 'note' }, 'What is near 1 still shapes distances at that time; what is near 0 is forgotten.'),
  );
}
