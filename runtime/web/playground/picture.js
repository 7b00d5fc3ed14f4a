// SPDX-License-Identifier: MIT
//
// Runs the kernels that roles.js has chosen, frame after frame, on the npm package.
import { Device } from 'streamkernel';

export class Picture {
  constructor(canvas, { failed, told }) {
    this.canvas = canvas;
    this.failed = failed; // called with an Error that ends the picture
    this.told = told; // called with frames and steps of a second, now and then
    this.device = null;
    this.program = null;
    this.options = { size: 256, steps: 8, map: 'magma' };
    this.streams = [];
    this.mouse = [-1, -1];
    this.pressed = false;
    this.paused = false;
    this.frame = 0;
    this.isRunning = false;
    this.watchMouse();
  }

  watchMouse() {
    const move = ({ clientX, clientY, buttons }) => {
      const box = this.canvas.getBoundingClientRect();
      const { size } = this.options;
      this.mouse = [((clientX - box.left) / box.width) * size, ((clientY - box.top) / box.height) * size];
      this.pressed = buttons > 0;
    };
    for (const name of ['pointerdown', 'pointermove', 'pointerup']) this.canvas.addEventListener(name, move);
    this.canvas.addEventListener('pointerleave', () => {
      this.mouse = [-1, -1];
      this.pressed = false;
    });
  }

  /** Shows another program. The streams go on where they have the same types; else it starts anew. */
  async show(module, roles) {
    const before = this.program?.roles.types.join();
    this.program = { module, roles };
    await this.openDevice();
    if (roles.types.join() !== before || this.streams.length === 0) this.restart();
    this.run();
  }

  /** Nothing is shown any more: the program is wrong. */
  stop() {
    this.program = null;
  }

  choose(options) {
    const isNewSize = options.size !== undefined && options.size !== this.options.size;
    this.options = { ...this.options, ...options };
    if (isNewSize && this.program !== null && this.device !== null) this.restart();
  }

  async openDevice() {
    if (this.device !== null && !this.device.lost) return;
    this.streams = [];
    this.shown = null;
    this.device = await Device.create();
    this.device.onlost = () => {
      this.failed(new Error('the browser has taken the GPU away, perhaps as a kernel took too long; press Restart to go on'));
    };
  }

  /** Runs the picture from its start; on a new device, where the last one is lost. */
  async restartAll() {
    if (this.program === null) return;
    await this.openDevice();
    this.restart();
    this.run();
  }

  restart() {
    const { roles } = this.program;
    const { size } = this.options;
    for (const stream of [...this.streams, this.shown]) stream?.dispose();
    this.streams = roles.types.map((type) => this.streamOf(type, size));
    this.shown = null;
    this.frame = 0;
    this.began = performance.now();
    if (roles.start !== null) this.call(roles.start);
  }

  streamOf(type, size) {
    return this.device.stream(this.program.module[type] ?? type, [size, size]);
  }

  /** Calls a kernel; `picture` is what a view writes. */
  call(kernel, picture) {
    const moment = { time: (performance.now() - this.began) / 1000, frame: this.frame, mouse: this.mouse, pressed: this.pressed };
    const values = kernel.arguments.map((argument) => {
      if ('value' in argument) return argument.value(moment);
      if ('read' in argument) return this.streams[argument.read];
      return picture ?? this.streams[argument.written];
    });
    const path = kernel.name.split('::');
    path.reduce((scope, name) => scope[name], this.program.module)(...values);
  }

  run() {
    if (this.isRunning) return;
    this.isRunning = true;
    let [frames, steps, since] = [0, 0, performance.now()];
    const draw = () => {
      if (this.program === null || this.device.lost) return (this.isRunning = false);
      try {
        if (!this.paused) steps += this.advance();
        this.draw();
      } catch (error) {
        this.isRunning = false;
        this.program = null;
        return this.failed(error);
      }
      ++frames;
      const now = performance.now();
      if (now - since > 1000) {
        this.told({ frames: (frames * 1000) / (now - since), steps: (steps * 1000) / (now - since) });
        [frames, steps, since] = [0, 0, now];
      }
      requestAnimationFrame(draw);
    };
    draw();
  }

  /** The steps of a frame; returns how many. */
  advance() {
    const { step } = this.program.roles;
    const count = step === null ? 0 : this.options.steps;
    for (let i = 0; i < count; ++i) this.call(step);
    ++this.frame;
    return count;
  }

  draw() {
    const { view } = this.program.roles;
    let [picture] = this.streams;
    if (view !== null) {
      const { type } = view.arguments.find((argument) => 'written' in argument);
      if (this.shown?.element.name !== type) {
        this.shown?.dispose();
        this.shown = this.streamOf(type, this.options.size);
      }
      picture = this.shown;
      this.call(view, picture);
    }
    this.device.draw(picture, this.canvas, { map: this.options.map });
  }
}
