// SPDX-License-Identifier: MIT
//
// The frame of every page: the device, the loop of frames, and what stands around the picture. A page is what openPage() is given.
import { Device, SkError } from 'streamkernel';
import { AccuracyPanel, milliseconds } from './accuracy.js';
import { CodeView, watchPrograms } from './code.js';
import { makeControls } from './controls.js';
import { listen } from './input.js';
import { Loop } from './loop.js';
import { randomFrom } from './random.js';

const at = (id) => document.getElementById(id);

/** What the address asks for: ?size=128&frames=20&seed=1&steps=4. Tests want small pictures, and the same ones each time. */
export function settingsOf(address) {
  const given = new URLSearchParams(address);
  const whole = (name, least, most) => {
    const text = given.get(name);
    if (text === null) return null;
    const value = Number(text);
    if (Number.isInteger(value) && value >= least && value <= most) return value;
    throw new SkError(`'${name}=${text}' in the address is no whole number from ${least} to ${most}; change it, or leave it out`);
  };
  return { size: whole('size', 16, 4096), frames: whole('frames', 0, 1e6), seed: whole('seed', 0, 2 ** 31), steps: whole('steps', 1, 1000) };
}

/** Shows an error in place of the picture, with something to do. */
function showError(error, again) {
  console.warn(error);
  const message = at('message');
  const text = error instanceof SkError || error.isForReader ? error.message : `This page has an error: ${error.message}`;
  message.replaceChildren(text);
  if (again !== undefined) {
    const button = document.createElement('button');
    button.textContent = 'Start again';
    button.onclick = again;
    message.append(button);
  }
  message.hidden = false;
  document.documentElement.dataset.state = 'failed';
}

/** A stretch of text under the picture, such as "heat in the plate: 1.0000". */
function figureWriter() {
  const help = at('help');
  const line = document.createElement('span');
  line.setAttribute('role', 'status');
  line.setAttribute('aria-live', 'off');
  return (text) => {
    if (line.parentElement === null) help.append(document.createElement('br'), line);
    line.textContent = text;
  };
}

class Page {
  constructor(spec) {
    this.spec = spec;
    this.settings = settingsOf(location.search);
    this.canvas = at('picture');
    this.isStill = matchMedia('(prefers-reduced-motion: reduce)').matches;
    at('help').textContent = spec.help;
    this.tell = figureWriter();
    this.controls = makeControls(at('controls'), spec.controls ?? [], (name) => this.changed(name));
    this.code = new CodeView(at('tabs'), at('text'), spec.sources);
  }

  async start() {
    at('message').hidden = true;
    this.device?.dispose();
    this.device = await Device.create({ powerPreference: 'high-performance' });
    this.code.forgetPrograms();
    watchPrograms(this.device.context, (program) => this.code.addProgram(program));
    this.device.onlost = () => this.lose();
    this.device.onrestored = () => this.restartAll(); // streams are empty then
    at('device').textContent = `Running on ${this.device.info().renderer}`;
    this.fenceStream = this.device.stream('float', [1]);
    this.prepared = await this.spec.prepare?.(this.device, this.settings.size ?? this.spec.width);
    this.makeSimulation();
    this.loop = new Loop({
      step: () => this.simulation.step(),
      draw: () => this.simulation.draw(),
      fence: () => this.fenceStream.read(),
      show: (figures) => this.showFigures(figures),
      fail: (error) => this.fail(error),
      wanted: this.settings.steps ?? this.spec.steps ?? 1,
      frames: this.settings.frames,
    });
    this.accuracy = new AccuracyPanel(this, this.spec.accuracy);
    this.bindButtons();
    this.stopListening?.();
    this.stopListening = listen(this.canvas, at('cursor'), (event) => this.point(event), () => this.toggle());
    if (this.isStill && this.settings.frames === null) {
      this.loop.once();
      this.tell('The picture stands still, as your system asks for less motion. Play starts it.');
      document.documentElement.dataset.state = 'ready';
    } else {
      this.loop.play();
    }
    this.showButtons();
  }

  makeSimulation() {
    const { spec, settings, canvas } = this;
    const width = settings.size ?? spec.width;
    canvas.width = width;
    canvas.height = Math.round(width * (spec.aspect ?? 1));
    this.simulation?.dispose?.();
    this.simulation = spec.create({
      device: this.device,
      canvas,
      page: this,
      prepared: this.prepared,
      controls: this.controls,
      random: randomFrom(settings.seed ?? 1),
      tell: this.tell,
      redraw: () => this.redraw(),
    });
    at('elements').textContent = this.simulation.elements.toLocaleString('en');
  }

  /** The loop draws anyway while it runs. */
  redraw() {
    if (this.loop !== undefined && !this.loop.isPlaying) this.guard(() => this.simulation.draw());
  }

  /** For work that may return a promise. */
  guard(work) {
    try {
      Promise.resolve(work()).catch((error) => this.fail(error));
    } catch (error) {
      this.fail(error);
    }
  }

  changed(name) {
    if (this.simulation === undefined || this.device.lost) return;
    this.guard(() => {
      this.simulation.changed?.(name);
      this.redraw();
    });
  }

  point(event) {
    if (this.device.lost || document.documentElement.dataset.state === 'failed') return;
    this.guard(() => {
      this.simulation.point?.(event);
      this.redraw();
    });
  }

  fail(error) {
    this.loop?.pause();
    if (error instanceof SkError && error.kind === 'lost') return this.lose();
    showError(error, () => this.restartAll());
    this.showButtons();
  }

  lose() {
    this.loop?.pause();
    const text = 'The browser has taken the graphics context away, and the picture with it. This happens when the GPU is reset or when many pages use it: ' +
      'close some of them, and start again.';
    showError(Object.assign(new Error(text), { isForReader: true }), () => this.restartAll());
    this.showButtons();
  }

  /** Everything anew, with a new context. */
  restartAll() {
    delete document.documentElement.dataset.state;
    const old = this.canvas;
    this.canvas = old.cloneNode(); // a canvas keeps its context for good
    old.replaceWith(this.canvas);
    this.simulation = undefined;
    this.start().catch((error) => showError(error, () => this.restartAll()));
  }

  toggle() {
    if (this.loop.isPlaying) this.loop.pause();
    else this.loop.play();
    this.showButtons();
  }

  bindButtons() {
    at('play').onclick = () => this.toggle();
    at('step').onclick = () => {
      this.loop.pause();
      this.loop.once();
      this.showButtons();
    };
    at('restart').onclick = () => this.guard(() => {
      this.makeSimulation();
      this.redraw();
    });
  }

  showButtons() {
    const isFine = !this.device?.lost && document.documentElement.dataset.state !== 'failed';
    for (const id of ['play', 'step', 'restart', 'measure']) at(id).disabled = !isFine;
    at('play').textContent = this.loop?.isPlaying ? 'Pause' : 'Play';
  }

  showFigures({ framesASecond, msAStep, steps, isDone }) {
    at('fps').textContent = framesASecond === null ? '–' : framesASecond.toFixed(0);
    at('ms').textContent = msAStep === null ? '–' : milliseconds(msAStep);
    at('steps').textContent = String(steps);
    if (!isDone) return;
    document.documentElement.dataset.state = 'done';
    this.showButtons();
  }
}

/** Runs a page; errors are shown in it. `window.gallery` is for the curious at the console. */
export function openPage(spec) {
  try {
    const page = new Page(spec);
    window.gallery = page;
    page.start().catch((error) => {
      const again = error instanceof SkError && error.kind === 'lost' ? () => page.restartAll() : undefined;
      showError(error, again);
    });
  } catch (error) {
    showError(error);
  }
}
