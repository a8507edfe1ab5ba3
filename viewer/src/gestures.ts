/** What a person asks of the map, whatever the device. Pixels of the element. */
export interface GestureTarget {
  pan(dx: number, dy: number): void;
  turn(dx: number, dy: number): void;
  zoom(factor: number, x: number, y: number): void;
  hover(x: number, y: number): void;
  leave(): void;
  click(x: number, y: number): void;
}

const CLICK_REACH = 4;
const WHEEL_SPEED = 0.0015;

type Point = { x: number; y: number };

function middle(a: Point, b: Point): Point {
  return { x: (a.x + b.x) / 2, y: (a.y + b.y) / 2 };
}

/**
 * Pointer and wheel gestures on `element`. One pointer pans (or turns, if `turnable`; with
 * shift or another button it pans), two pinch and pan. The wheel zooms once the element has
 * the focus or with Ctrl, so that it does not stop the page from scrolling.
 */
export function listenToGestures(
  element: HTMLElement,
  target: GestureTarget,
  turnable: boolean,
): void {
  const pointers = new Map<number, Point>();
  let start: Point | null = null;

  const place = (event: MouseEvent): Point => {
    const box = element.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  const moveOne = (event: PointerEvent, from: Point, to: Point) => {
    const pans = !turnable || event.shiftKey || (event.buttons & ~1) !== 0;
    if (pans) target.pan(to.x - from.x, to.y - from.y);
    else target.turn(to.x - from.x, to.y - from.y);
  };

  const moveTwo = (id: number, from: Point, to: Point) => {
    const other = [...pointers].find(([key]) => key !== id)?.[1];
    if (!other) return;
    const [before, after] = [middle(from, other), middle(to, other)];
    target.pan(after.x - before.x, after.y - before.y);
    const spread = Math.hypot(from.x - other.x, from.y - other.y);
    const factor = Math.hypot(to.x - other.x, to.y - other.y) / spread;
    if (Number.isFinite(factor) && factor > 0) target.zoom(factor, after.x, after.y);
  };

  element.addEventListener('pointerdown', (event) => {
    pointers.set(event.pointerId, place(event));
    start = pointers.size === 1 ? place(event) : null;
    element.setPointerCapture(event.pointerId);
  });
  element.addEventListener('pointermove', (event) => {
    const from = pointers.get(event.pointerId);
    const to = place(event);
    if (!from) {
      target.hover(to.x, to.y);
      return;
    }
    if (start && Math.hypot(to.x - start.x, to.y - start.y) < CLICK_REACH) return;
    start = null;
    if (pointers.size === 1) moveOne(event, from, to);
    else moveTwo(event.pointerId, from, to);
    pointers.set(event.pointerId, to);
  });
  const end = (event: PointerEvent) => {
    pointers.delete(event.pointerId);
    if (event.type === 'pointerup' && start) target.click(start.x, start.y);
    start = null;
  };
  element.addEventListener('pointerup', end);
  element.addEventListener('pointercancel', end);
  element.addEventListener('pointerleave', () => target.leave());
  element.addEventListener('contextmenu', (event) => event.preventDefault());
  element.addEventListener(
    'wheel',
    (event) => {
      if (document.activeElement !== element && !event.ctrlKey) return;
      event.preventDefault();
      const { x, y } = place(event);
      target.zoom(Math.exp(-event.deltaY * WHEEL_SPEED), x, y);
    },
    { passive: false },
  );
}
