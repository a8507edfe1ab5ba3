import { html } from './dom';

/** What of a panel can be saved; each is made when it is asked for. */
export interface Savable {
  /** rows of cells, the names of the columns first */
  csv?: () => string[][];
  svg?: () => SVGSVGElement;
}

const SHARPNESS = 2;

/** A table as CSV (RFC 4180, lines end with a line feed). */
export function csvText(rows: readonly (readonly string[])[]): string {
  const cell = (text: string) => (/[",\r\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
  return rows.map((row) => `${row.map(cell).join(',')}\n`).join('');
}

/** A number with all its digits, for programs; NaN and infinity as verdict files have them. */
export function exact(value: number): string {
  if (Number.isNaN(value)) return 'nan';
  if (!Number.isFinite(value)) return value > 0 ? 'inf' : '-inf';
  // A float of 32 bits is told apart by nine digits.
  return String(Number(value.toPrecision(9)));
}

/** A name of a file that every system takes: what was read, and the panel. */
export function fileName(title: string, panel: string, suffix: string): string {
  const stem = title.replace(/[^\p{L}\p{N}._-]+/gu, '_').slice(0, 80);
  return `${stem || 'report'}-${panel}.${suffix}`;
}

function save(name: string, content: Blob): void {
  const url = URL.createObjectURL(content);
  const link = html('a', { href: url, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(url), 60_000);
}

function svgText(picture: SVGSVGElement): string {
  return `${new XMLSerializer().serializeToString(picture)}\n`;
}

/** The picture in pixels. */
async function rasterised(picture: SVGSVGElement): Promise<Blob> {
  const image = new Image();
  image.src = `data:image/svg+xml;charset=utf-8,${encodeURIComponent(svgText(picture))}`;
  await image.decode();
  const canvas = document.createElement('canvas');
  canvas.width = SHARPNESS * Number(picture.getAttribute('width'));
  canvas.height = SHARPNESS * Number(picture.getAttribute('height'));
  canvas.getContext('2d')!.drawImage(image, 0, 0, canvas.width, canvas.height);
  return new Promise((done, fail) =>
    canvas.toBlob((blob) => (blob ? done(blob) : fail(new Error('no picture'))), 'image/png'),
  );
}

/** Buttons that save what a panel shows: pictures as PNG and SVG, numbers as CSV. */
export function saveButtons(title: string, panel: string, what: Savable): HTMLElement {
  const { csv, svg } = what;
  const actions: [string, () => Blob | Promise<Blob>][] = [];
  if (svg) {
    actions.push(['png', () => rasterised(svg())]);
    actions.push(['svg', () => new Blob([svgText(svg())], { type: 'image/svg+xml' })]);
  }
  if (csv) actions.push(['csv', () => new Blob([csvText(csv())], { type: 'text/csv' })]);
  const buttons = actions.map(([suffix, make]) => {
    const label = suffix.toUpperCase();
    const name = fileName(title, panel, suffix);
    const button = html(
      'button',
      { type: 'button', title: `Save ${name}`, 'aria-label': `Save ${panel} as ${label}`, 'data-save': suffix },
      label,
    );
    button.addEventListener('click', async () => save(name, await make()));
    return button;
  });
  return html('div', { class: 'save', role: 'group', 'aria-label': 'Save' }, ...buttons);
}
