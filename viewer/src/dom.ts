/** Attributes of an element; undefined and false leave one out. */
export type Attributes = Record<string, string | number | boolean | undefined>;

function setAttributes(element: Element, attributes: Attributes): void {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === false) continue;
    element.setAttribute(name, value === true ? '' : String(value));
  }
}

/** An HTML element. Strings become text, never markup: nothing in a document can run. */
export function html<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  setAttributes(element, attributes);
  element.append(...children);
  return element;
}

/** An SVG element. */
export function svg<Tag extends keyof SVGElementTagNameMap>(
  tag: Tag,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS('http://www.w3.org/2000/svg', tag);
  setAttributes(element, attributes);
  element.append(...children);
  return element;
}

/** A section of the page with a heading; `name` is how tests and links find it. */
export function panel(name: string, title: string, ...children: (Node | string)[]): HTMLElement {
  return html(
    'section',
    { class: 'panel', id: name, 'data-panel': name, 'aria-labelledby': `${name}-title` },
    html('h2', { id: `${name}-title` }, title),
    ...children,
  );
}

/** What a panel says where it has nothing to draw. */
export function absent(reason: string): HTMLElement {
  return html('p', { class: 'absent' }, reason);
}
