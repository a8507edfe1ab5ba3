import assert from 'node:assert/strict';
import test from 'node:test';
import { chartCsv } from '../src/chart_csv';
import { csvText, exact, fileName } from '../src/save';

test('cells that hold commas, quotes or lines are quoted', () => {
  assert.equal(csvText([['a', 'b,c'], ['d"e', 'f\ng']]), 'a,"b,c"\n"d""e","f\ng"\n');
});

test('numbers are saved with the digits that a float has', () => {
  assert.equal(exact(Math.fround(0.1)), '0.100000001');
  assert.equal(Math.fround(Number(exact(Math.fround(1 / 3)))), Math.fround(1 / 3));
  assert.deepEqual([exact(NaN), exact(Infinity), exact(-Infinity)], ['nan', 'inf', '-inf']);
});

test('files are named after what was read, in letters that every system takes', () => {
  assert.equal(fileName('map.g2o', 'scores', 'csv'), 'map.g2o-scores.csv');
  assert.equal(fileName('a/b <c>', 'map', 'svg'), 'a_b_c_-map.svg');
  assert.equal(fileName('', 'map', 'svg'), 'report-map.svg');
});

test('a chart is saved as a row a point', () => {
  const rows = chartCsv({
    description: '',
    x: { label: 'x' },
    y: { label: 'y' },
    xs: [1, 2],
    series: [
      { label: 'a', colour: '', kind: 'line', values: [0.5, null] },
      { label: 'b', colour: '', kind: 'bars', values: [7, 9], saved: [3, 4] },
    ],
    names: { columns: ['pose'], of: (point) => [`p${point}`] },
  });
  assert.deepEqual(rows, [['pose', 'x', 'a', 'b'], ['p0', '1', '0.5', '3'], ['p1', '2', '', '4']]);
});
