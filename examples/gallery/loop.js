// SPDX-License-Identifier: MIT
//
// Frames: some steps, then a picture. At most one frame is on its way to the device, so that slow devices do not lag behind, and
// there are as many steps in a frame as the device makes in some milliseconds.

const budget = 12; // ms of the device in a frame
const measuredEvery = 24;

export class Loop {
  /** `step` and `draw` may return promises. `wanted`: steps in a frame where there is time for them. `frames`: ends after so many, without adapting; null goes on. */
  constructor({ step, draw, fence, show, fail, wanted, frames }) {
    Object.assign(this, { step, draw, fence, show, fail, wanted, frames });
    this.steps = frames === null ? Math.min(wanted, 2) : wanted;
    this.isPlaying = false;
    this.isBusy = false;
    this.count = 0;
    this.msAStep = null;
    this.drawn = [];
  }

  play() {
    if (this.isPlaying) return;
    this.isPlaying = true;
    this.drawn = [];
    const next = () => requestAnimationFrame(async () => {
      if (!this.isPlaying) return;
      await this.once();
      if (this.isPlaying) next();
    });
    if (this.frames !== null && this.count >= this.frames) this.frames = null; // somebody wants more
    next();
  }

  pause() {
    this.isPlaying = false;
  }

  /** One frame. */
  async once() {
    if (this.isBusy) return;
    this.isBusy = true;
    try {
      await this.frame();
    } catch (error) {
      this.isPlaying = false;
      this.fail(error);
    }
    this.isBusy = false;
  }

  async frame() {
    const isMeasured = this.count % measuredEvery === 3;
    const { steps } = this;
    const begin = performance.now();
    for (let i = 0; i < steps; ++i) await this.step();
    if (isMeasured) {
      await this.fence();
      this.adapt((performance.now() - begin) / steps);
    }
    await this.draw();
    await this.fence();
    ++this.count;
    const now = performance.now();
    this.drawn = [...this.drawn.filter((time) => time > now - 1000), now];
    const span = now - this.drawn[0];
    const isDone = this.frames !== null && this.count === this.frames;
    if (isDone) this.pause();
    const framesASecond = this.isPlaying && span > 200 ? ((this.drawn.length - 1) * 1000) / span : null;
    this.show({ framesASecond, msAStep: this.msAStep, steps, isDone });
  }

  /** The first measurements hold the compilation of programs, which no later one has to pay. */
  adapt(ms) {
    this.msAStep = this.msAStep === null ? ms : Math.min(2 * this.msAStep, 0.6 * this.msAStep + 0.4 * ms);
    if (this.frames !== null) return;
    this.steps = Math.max(1, Math.min(this.wanted, Math.floor(budget / this.msAStep)));
  }

  /** Waits until no frame is on its way, does some work, and goes on. */
  async aside(work) {
    const wasPlaying = this.isPlaying;
    this.pause();
    while (this.isBusy) await new Promise((resolve) => setTimeout(resolve, 1));
    try {
      return await work();
    } finally {
      if (wasPlaying) this.play();
    }
  }
}
