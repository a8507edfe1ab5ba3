import { chart } from './chart';
import { absent, html, panel } from './dom';
import { count, number } from './format';
import type { Histogram } from './histogram';
import { histogram, stacked } from './histogram';
import type { Model } from './model';
import { VERDICTS } from './model';
import type { Store } from './store';

/** Log odds beyond which certain is certain: drawn in full they would push all others together. */
const CERTAIN = 50;

/** The one threshold of all candidates, or null if they differ. */
function commonThreshold(model: Model): number | null {
  const { threshold } = model.candidates;
  return threshold.every((value) => value === threshold[0]) ? threshold[0] : null;
}

function tell(model: Model, { edges, counts }: Histogram, bin: number): string {
  const heights = VERDICTS.map((name, verdict) => `${name}: ${count(counts[verdict][bin])}`);
  return [`${number(edges[bin])} to ${number(edges[bin + 1])}, ${model.nouns.edges}`, ...heights].join('\n');
}

/** What the outer bars hold besides, in words. */
function wordsOfOuterBars(scores: Float32Array, most: number): string {
  const beyond = (far: (score: number) => boolean) =>
    scores.reduce((sum, score) => sum + Number(far(score)), 0);
  if (Number.isFinite(most)) {
    const far = beyond((score) => Math.abs(score) > most);
    return far > 0 ? `${count(far)} scores beyond ±${most} are counted in the outer bars.` : '';
  }
  const infinite = beyond((score) => score === Infinity);
  return infinite > 0 ? `${count(infinite)} infinite scores are counted in the last bar.` : '';
}

/** How the scores lie around the threshold. */
export function scorePanel(model: Model, store: Store): HTMLElement {
  const { candidates, nouns } = model;
  const title = 'Scores and threshold';
  if (candidates.count === 0) return panel('scores', title, absent('There are no scores.'));
  const common = commonThreshold(model);
  // Scores with thresholds of their own are only comparable as ratios.
  const values =
    common === null ? candidates.score.map((s, k) => s / candidates.threshold[k]) : candidates.score;
  const threshold = common ?? 1;
  const most = candidates.columns.some(({ key }) => key === 'probability') ? CERTAIN : Infinity;
  const bins = histogram(values, candidates.verdict, VERDICTS.length, most);
  // The tallest stack is drawn first, the others over it.
  const stacks = stacked(bins.counts);
  const series = VERDICTS.map((name, verdict) => ({
    label: name,
    colour: `--${name}`,
    kind: 'bars' as const,
    values: [...stacks[verdict], 0],
    saved: [...bins.counts[verdict], 0],
  }))
    .filter((_, verdict) => candidates.verdict.includes(verdict))
    .reverse();
  return panel(
    'scores',
    title,
    chart(
      model.title,
      'scores',
      {
        description: `Histogram of the scores of ${count(candidates.count)} ${nouns.edges}, threshold ${number(threshold)}`,
        x: { label: common === null ? 'score / threshold' : 'score', log: bins.log },
        y: { label: nouns.edges },
        xs: bins.edges,
        series,
        tell: (bin) => tell(model, bins, bin),
        marks: Number.isFinite(threshold)
          ? [{ axis: 'x', value: threshold, label: `threshold ${number(threshold)}` }]
          : [],
      },
      store,
    ),
    html('p', { class: 'note' }, wordsOfOuterBars(candidates.score, most)),
  );
}
