import { number, quantity } from './format';
import type { Layout, Model } from './model';
import { candidateName, nodeName, stageOf, verdictOf } from './model';

/** What the pointer is told about a candidate: verdict, score and the numbers of its columns. */
export function candidateWords(model: Model, candidate: number): string[] {
  const { candidates, nouns } = model;
  const [score, threshold] = [candidates.score[candidate], candidates.threshold[candidate]];
  const limit = Number.isFinite(threshold) ? `, threshold ${number(threshold)}` : '';
  const columns = candidates.columns.map(
    ({ label, unit, values }) => `${label}: ${quantity(values[candidate], unit)}`,
  );
  return [
    `${nouns.edge} ${candidateName(model, candidate)}: ` +
      `${verdictOf(model, candidate)}, ${stageOf(model, candidate)}`,
    `score: ${number(score)}${limit}`,
    ...columns,
  ];
}

/** What it is told about a node: where it is, whose, and how far from where it belongs. */
export function nodeWords(model: Model, layout: Layout, node: number): string[] {
  const { dimension, nouns, robots, unit } = model;
  const place = layout.origin
    .slice(0, dimension)
    .map((origin, d) => number(origin + layout.positions[dimension * node + d]));
  const words = [
    `${nouns.node} ${nodeName(model, node)}: (${place.join(', ')})${unit === '' ? '' : ` ${unit}`}`,
  ];
  if (robots) words.push(`robot: ${robots.names[robots.of[node]]}`);
  if (layout.errors && !Number.isNaN(layout.errors[node])) {
    words.push(`error: ${quantity(layout.errors[node], unit)}`);
  }
  for (const { label, unit: of, values } of model.nodeColumns) {
    words.push(`${label}: ${quantity(values[node], of)}`);
  }
  return words;
}
