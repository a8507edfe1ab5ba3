import type { ChartSpec } from './chart_spec';
import { exact } from './save';

/** The numbers of a chart: a row a point, a column a series; nothing where there is none. */
export function chartCsv(spec: ChartSpec): string[][] {
  const names = spec.names ?? { columns: [], of: () => [] };
  const rows = [[...names.columns, spec.x.label, ...spec.series.map(({ label }) => label)]];
  for (let k = 0; k < spec.xs.length; ++k) {
    const cells = spec.series.map(({ values, saved }) => {
      const value = (saved ?? values)[k];
      return value === null ? '' : exact(value);
    });
    rows.push([...names.of(k), exact(spec.xs[k]), ...cells]);
  }
  return rows;
}
