// SPDX-License-Identifier: MIT
//
// What pages with fields of numbers share: pictures by examples/applications/lattice/view.sk, and strokes of a finger. Row 0 of a field is the
// bottom of its picture.
import { brush } from './sk/gallery/brush.sk.js';
import { lattice as view } from './sk/lattice/view.sk.js';
import { storage } from './sk/gallery/storage.sk.js';
import { palette } from './colours.js';

/** Shows fields of rows x columns in a canvas. */
export class Painter {
  constructor(device, canvas, colours) {
    Object.assign(this, { device, canvas });
    this.palette = device.stream('float3', [256]);
    this.palette.write(palette(colours));
    this.colour = device.stream('float3', [canvas.height, canvas.width]);
  }

  draw(field, low, high, relief = 0) {
    const cells = field.shape[1] / this.canvas.width;
    view.paint(relief > 0, this.palette, low, high, relief, cells, field, this.colour);
    this.device.draw(this.colour, this.canvas);
  }
}

/** An event for fields whose row 0 is the top of their picture. */
export const downwards = (event) => ({ ...event, y: 1 - event.y, lastY: 1 - event.lastY });

/** Strokes along the way of a pointer: value and share for each field, both with a number for each component. */
export function stroke(event, radius, ...fields) {
  for (const [field, value, share] of fields) {
    const [rows, columns] = field.shape.slice(-2);
    const place = (x, y) => [x * columns, (1 - y) * rows];
    brush.stroke(place(event.lastX, event.lastY), place(event.x, event.y), radius, value, share, field, field);
  }
}

/** A step of fields that are kept in halves in between, `half`, `half2` or `half3`: each is widened before, and rounded after. */
export class InHalves {
  constructor(device, fields, type = 'half') {
    this.fields = fields;
    this.halves = fields.map((field) => device.stream(type, field.shape));
    this.store();
  }

  store() {
    this.fields.forEach((field, i) => storage.toHalf(field, this.halves[i]));
  }

  step(work) {
    this.fields.forEach((field, i) => storage.toFloat(this.halves[i], field));
    work();
    this.store();
  }
}

/** What streams of halves between passes would do to fields of a shape. */
export class RoundToHalves {
  constructor(device, shape, type = 'half') {
    this.half = device.stream(type, shape);
  }

  pass(field) {
    storage.toHalf(field, this.half);
    storage.toFloat(this.half, field);
  }
}

/** Rows of the accuracy panel for sums of a field: plain, and compensated, against doubles. */
export async function* sumRows(field, { timeAnswer }, what) {
  const elements = await field.read();
  const total = elements.reduce((sum, x) => sum + x, 0);
  for (const accumulate of ['tree', 'compensated']) {
    const sum = storage.sum.with({ accumulate });
    const error = Math.abs((await sum(field)) - total) / Math.abs(total || 1);
    yield { choice: `${what}, ${accumulate}`, ms: await timeAnswer(() => sum(field)), error };
  }
}
