// SPDX-License-Identifier: MIT
//
// A curtain by the kernels of examples/applications/cloth, in metres and seconds. Its hand and its ball are in kernels/grab.sk.
import { measure } from '../cloth_accuracy.js';
import { MeshView } from '../mesh_view.js';
import { openPage } from '../page.js';
import { cloth } from '../sk/cloth/cloth.sk.js';
import { hand } from '../sk/gallery/grab.sk.js';

const dt = 1 / 900;
const rounds = 3; // of relaxation in a step
const [wide, tall] = [1.6, 1.2];
const gravity = 9.81;
const [exact, displacements] = [0, 0]; // Law and Verlet of the .sk files
const thickness = 0.014;

/** The bits of a point's links; see linksAt() in examples/applications/cloth/model.cpp. */
const directions = [[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, -1], [-1, 1], [1, -1], [2, 0], [-2, 0], [0, 2], [0, -2]];
const linksAt = (x, y, columns, rows) =>
  directions.reduce((bits, [dx, dy], k) => (x + dx >= 0 && x + dx < columns && y + dy >= 0 && y + dy < rows ? bits | (1 << k) : bits), 0);

function firstState(columns, rows, random) {
  const p = new Float32Array(4 * columns * rows);
  const alive = new Int32Array(columns * rows);
  const hooks = Math.max(2, Math.round((columns - 1) / 5));
  for (let y = 0; y < rows; ++y) {
    for (let x = 0; x < columns; ++x) {
      const i = y * columns + x;
      const isHook = y === 0 && x % hooks === 0;
      const shake = isHook ? 0 : 0.004 * (2 * random() - 1);
      p.set([(x / (columns - 1) - 0.5) * wide * 0.94, tall * (1 - y / (rows - 1)), 0.03 * Math.sin((24 * x) / columns) + shake, isHook ? 0 : 1], 4 * i);
      alive[i] = linksAt(x, y, columns, rows);
    }
  }
  return { p, alive };
}

class Curtain {
  constructor({ device, canvas, controls, random, tell }) {
    Object.assign(this, { device, controls, tell });
    this.columns = Math.min(Math.max(16, canvas.width >> 4), 80);
    this.rows = Math.round((this.columns * 3) / 4);
    const shape = [this.rows, this.columns];
    this.elements = this.rows * this.columns;
    this.p = device.stream('float4', shape);
    this.d = device.stream('float3', shape);
    this.alive = device.stream('int', shape);
    this.held = device.stream('uchar', shape);
    this.at = device.stream('float4', shape);
    this.normal = device.stream('float4', shape);
    const first = firstState(this.columns, this.rows, random);
    this.p.write(first.p);
    this.alive.write(first.alive);
    this.positions = first.p;
    this.view = canvas.view ??= new MeshView(canvas, [0, 0.56, 3.1], 0.48);
    this.mesh = this.view.mesh(this.rows, this.columns);
    const right = wide / (this.columns - 1);
    const relaxation = 1.2 / (4 * (1 + 0.5 + 0.1)); // stiffnessAround() of these links
    this.links = { right, down: right, diagonal: Math.SQRT2 * right, structural: relaxation, shear: 0.5 * relaxation, bend: 0.1 * relaxation };
    this.motion = { gravity: [0, -gravity * dt * dt, 0], keep: 1 - 0.4 * dt };
    this.air = (0.5 * 1.2 * right * right * this.elements) / 0.3; // density, area, and the mass of 0.3 kg
    this.time = 0;
    this.grip = null;
    this.ball = this.ballAt(0);
  }

  ballAt(time) {
    return { centre: [0.24 * Math.sin(0.6 * time), 0.4, -0.34 + 0.3 * Math.sin(1.1 * time)], radius: 0.25 };
  }

  wind() {
    const speed = this.controls.get('wind');
    const velocity = [0.5 * speed * dt, 0, -speed * dt];
    const wave = [0.447 * 4.8, 0, -0.894 * 4.8];
    return { velocity, across: 1.6 * this.air, along: 0.06 * this.air, gust: 0.5, swirl: 0.4, phase: (2 * Math.PI * this.time) / 1.7, wave };
  }

  step() {
    const { p, d, alive, links } = this;
    const net = {structural: true, shear: true, bend: true, tearing: true, law: exact, links, p};
    const loose = {...net, structural: false, shear: false, bend: false};
    const forces = {motion: this.motion, windy: true, air: this.wind()};
    this.time += dt;
    cloth.integrate(loose, forces, {carried: false}, displacements, d, alive, null, p, d);
    if (this.grip !== null) this.pull();
    for (let round = 0; round < rounds; ++round) cloth.relax(net, displacements, d, alive, p, d);
    const ball = this.ballAt(this.time);
    const moved = ball.centre.map((x, c) => x - this.ball.centre[c]);
    this.ball = ball;
    if (this.controls.get('ball')) hand.touchBall({ ...ball, moved, friction: 0.3 }, thickness, p, d, p, d);
    if (this.controls.get('tears')) cloth.tear(net, 1.9, alive, alive);
  }

  /** The hand follows the pointer, at 3 m/s at most. */
  pull() {
    const { grip } = this;
    const way = grip.target.map((x, c) => x - grip.at[c]);
    const length = Math.hypot(...way);
    const part = Math.min(0.1, (3 * dt) / Math.max(length, 1e-9));
    const by = way.map((x) => part * x);
    grip.at = grip.at.map((x, c) => x + by[c]);
    hand.carry(by, this.held, this.p, this.d, this.p, this.d);
  }

  draw() {
    cloth.dress(true, this.p, this.alive, this.at, this.normal);
    Promise.all([this.at.read(), this.normal.read()]).then(([at, normal]) => this.show(at, normal), () => {}); // a lost context is told elsewhere
  }

  show(at, normal) {
    this.positions = at;
    this.view.fill(this.mesh, at, normal, (i) => normal[4 * i + 3]);
    this.view.draw(this.mesh, this.controls.get('ball') ? this.ball : { centre: [0, 0, 99], radius: 1e-3 });
  }

  /** The point that is nearest to a place in the picture, if one is near. */
  nearest(x, y) {
    let best = { distance: 0.08, point: null };
    for (let i = 0; i < this.elements; ++i) {
      const point = this.positions.subarray(4 * i, 4 * i + 3);
      const [px, py] = this.view.project(point);
      const distance = Math.hypot(px - x, (py - y) * 0.75);
      if (distance < best.distance) best = { distance, point };
    }
    return best.point;
  }

  point(event) {
    if (event.kind === 'down') {
      const point = this.nearest(event.x, event.y);
      if (point === null) return;
      this.grip = { at: [...point], target: [...point], distance: this.view.project(point)[2] };
      hand.take(this.grip.at, 1.6 * this.links.right, this.p, this.p, this.held);
    } else if (this.grip !== null && event.kind === 'move') {
      this.grip.target = this.view.unproject(event.x, event.y, this.grip.distance);
    } else if (this.grip !== null) {
      this.grip = null;
      hand.release(this.held, this.p, this.p, this.held);
    }
  }
}

openPage({
  width: 960,
  aspect: 0.75,
  steps: 15,
  help: 'Drag the cloth. Keys: arrows move the hand, hold Space to grab and move on, P pauses.',
  controls: [
    { name: 'wind', label: 'Wind, m/s', range: [0, 6, 0.1], value: 2, show: (x) => x.toFixed(1) },
    { name: 'ball', label: 'A ball swings behind it', isOn: true },
    { name: 'tears', label: 'Links tear at 1.9 times their length', isOn: true },
  ],
  sources: ['sk/cloth/cloth.sk', 'sk/cloth/links.sk', 'sk/cloth/contacts.sk', 'sk/gallery/grab.sk'],
  create: (context) => new Curtain(context),
  accuracy: {
    note: 'A net falls and hangs, 16 metres from the origin. Verlet’s method may keep displacements or the last positions, and links may be measured exactly or without a ' +
      'square root. Errors of positions, in the size of the net, against doubles in JavaScript; times are those of a step of the cloth above.',
    measure,
  },
});
