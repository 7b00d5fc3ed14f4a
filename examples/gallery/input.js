// SPDX-License-Identifier: MIT
//
// Pointers and keys on the picture, as one kind of event: { kind: 'down' | 'move' | 'up', x, y, lastX, lastY, isErasing } with places from 0
// to 1, from the upper left corner. Keys move a cursor: arrows, and space or Enter to press.

const stepOfKeys = 0.025;
const directions = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Returns a function that ends it. */
export function listen(canvas, cursor, point, toggle) {
  const ending = new AbortController();
  const on = (name, handler, options = {}) => canvas.addEventListener(name, handler, { ...options, signal: ending.signal });
  const place = { x: 0.5, y: 0.5 };
  let isDown = false;

  const send = (kind, x, y, isErasing) => {
    const event = { kind, x, y, lastX: kind === 'down' ? x : place.x, lastY: kind === 'down' ? y : place.y, isErasing };
    place.x = x;
    place.y = y;
    point(event);
  };
  const inside = (value) => Math.min(Math.max(value, 0), 1);
  const placeOf = (event) => {
    const box = canvas.getBoundingClientRect();
    return [inside((event.clientX - box.left) / box.width), inside((event.clientY - box.top) / box.height)];
  };

  on('pointerdown', (event) => {
    if (event.button > 0 && event.button !== 2) return;
    canvas.setPointerCapture(event.pointerId);
    canvas.focus({ preventScroll: true });
    cursor.hidden = true;
    isDown = true;
    send('down', ...placeOf(event), event.shiftKey || event.button === 2);
    event.preventDefault();
  });
  on('pointermove', (event) => {
    if (isDown) send('move', ...placeOf(event), event.shiftKey || (event.buttons & 2) !== 0);
  });
  const release = (event) => {
    if (!isDown) return;
    isDown = false;
    send('up', place.x, place.y, event.shiftKey);
  };
  on('pointerup', release);
  on('pointercancel', release);
  on('contextmenu', (event) => event.preventDefault());

  const showCursor = () => {
    cursor.hidden = false;
    cursor.classList.toggle('down', isDown);
    cursor.style.left = `${100 * place.x}%`;
    cursor.style.top = `${100 * place.y}%`;
  };
  on('keydown', (event) => {
    const way = directions[event.key];
    const isPress = event.key === ' ' || event.key === 'Enter';
    if (way !== undefined) {
      const x = inside(place.x + way[0] * stepOfKeys);
      const y = inside(place.y + way[1] * stepOfKeys);
      if (isDown) send('move', x, y, event.shiftKey);
      else Object.assign(place, { x, y });
    } else if (isPress && !isDown) {
      isDown = true;
      send('down', place.x, place.y, event.shiftKey);
    } else if (event.key === 'p' && !event.ctrlKey && !event.metaKey) {
      return toggle();
    } else if (!isPress) {
      return;
    }
    showCursor();
    event.preventDefault();
  });
  on('keyup', (event) => {
    if (event.key !== ' ' && event.key !== 'Enter') return;
    release(event);
    showCursor();
  });
  on('blur', (event) => {
    release(event);
    cursor.hidden = true;
  });
  return () => ending.abort();
}
