/** A number for people: four significant digits, no unit. */
export function number(value: number | null | undefined): string {
  if (value === null || value === undefined || Number.isNaN(value)) return '–';
  if (value === Infinity) return '∞';
  if (value === -Infinity) return '−∞';
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e6 || size < 1e-3)) {
    return value.toExponential(2).replace('e+', 'e').replace('-', '−').replace('e-', 'e−');
  }
  return String(Number(value.toPrecision(4))).replace('-', '−');
}

/** A count with thousands apart. */
export function count(value: number): string {
  return value.toLocaleString('en-US');
}

/** A number with its unit. */
export function quantity(value: number, unit: string): string {
  return unit === '' ? number(value) : `${number(value)} ${unit}`;
}

/** A noun with its article. */
export function aOrAn(noun: string): string {
  return `${/^[aeiou]/i.test(noun) ? 'an' : 'a'} ${noun}`;
}

/** The first letter in capitals, if it is of the alphabet: chi stays as it is. */
export function capital(text: string): string {
  return text.replace(/^[a-z]/, (letter) => letter.toUpperCase());
}

const RAISED = '⁰¹²³⁴⁵⁶⁷⁸⁹';

/** A power of ten as a logarithmic axis names it. */
export function powerOfTen(value: number): string {
  const power = Math.round(Math.log10(value));
  if (power > -3 && power < 5) return number(value);
  const digits = String(Math.abs(power)).replace(/\d/g, (digit) => RAISED[Number(digit)]);
  return `10${power < 0 ? '⁻' : ''}${digits}`;
}

/** The largest of 1, 2 and 5 times a power of ten that is at most `limit`. */
export function roundLength(limit: number): number {
  const power = 10 ** Math.floor(Math.log10(limit));
  for (const digit of [5, 2]) if (digit * power <= limit) return digit * power;
  return power;
}
