import assert from 'node:assert/strict';
import test from 'node:test';
import { capital, number, powerOfTen, roundLength } from '../src/format';

test('numbers have four digits and no unit', () => {
  assert.equal(number(3.14159), '3.142');
  assert.equal(number(0), '0');
  assert.equal(number(-2.5), '−2.5');
  assert.equal(number(1234567), '1.23e6');
  assert.equal(number(0.00012345), '1.23e−4');
  assert.equal(number(NaN), '–');
  assert.equal(number(null), '–');
  assert.equal(number(Infinity), '∞');
});

test('axes name powers of ten', () => {
  assert.equal(powerOfTen(1000), '1000');
  assert.equal(powerOfTen(1e6), '10⁶');
  assert.equal(powerOfTen(1e-12), '10⁻¹²');
});

test('only letters of the alphabet become capitals', () => {
  assert.equal(capital('loop'), 'Loop');
  assert.equal(capital('χ² map'), 'χ² map');
});

test('lengths of scale bars are round and not too long', () => {
  for (const limit of [0.013, 1, 1.99, 7, 49.9, 1234]) {
    const length = roundLength(limit);
    assert.ok(length <= limit && length > limit / 2.6);
  }
});
