// SPDX-License-Identifier: MIT
//
// Entries for the browser's performance panel: calls, compilations, transfers and passes, each in a track of its own.
// Chrome shows them under "StreamKernel" (detail.devtools); others list them as user timings.

type Track = 'calls' | 'results' | 'passes' | 'compilations' | 'transfers';

/** EXT_disjoint_timer_query_webgl2 */
interface Timer {
  readonly TIME_ELAPSED_EXT: number;
  readonly GPU_DISJOINT_EXT: number;
}

interface Timed {
  readonly name: string;
  readonly texels: number;
  readonly start: number;
  readonly query: WebGLQuery;
}

/** What is traced. */
interface Traced {
  readonly context: WebGL2RenderingContext;
  readonly lost: boolean;
}

export class Trace {
  private readonly gl: WebGL2RenderingContext;
  private readonly timer: Timer | null;
  private readonly timed: Timed[] = [];
  /** When the last pass ended on the device. */
  private end = 0;
  private isPolling = false;

  constructor(private readonly device: Traced) {
    this.gl = device.context;
    this.timer = this.gl.getExtension('EXT_disjoint_timer_query_webgl2') as Timer | null;
  }

  /** An entry that begins at `start`, in milliseconds of performance.now(). */
  measure(track: Track, name: string, start: number, end = performance.now(), properties: readonly (readonly [string, string])[] = []): void {
    const color = { calls: 'primary', results: 'primary-light', passes: 'secondary', compilations: 'error', transfers: 'tertiary' }[track];
    performance.measure(name, { start, end, detail: { devtools: { dataType: 'track-entry', trackGroup: 'StreamKernel', track, color, properties } } });
  }

  /** Runs a call. What it promises has a second entry, up to the result. */
  call<T>(name: string, run: () => T): T {
    const start = performance.now();
    try {
      const result = run();
      if (result instanceof Promise) {
        const done = () => this.measure('results', name, start);
        result.then(done, done);
      }
      return result;
    } finally {
      this.measure('calls', name, start);
    }
  }

  /** Draws a pass. Its entry has the device's time if the browser tells it, and begins when the pass before has ended. */
  pass(name: string, texels: number, draw: () => void): void {
    const { gl, timer } = this;
    const start = performance.now();
    const query = timer === null ? null : gl.createQuery();
    if (query === null) {
      draw();
      return this.measure('passes', name, start, performance.now(), properties(texels, 'of the host'));
    }
    gl.beginQuery(timer!.TIME_ELAPSED_EXT, query);
    draw();
    gl.endQuery(timer!.TIME_ELAPSED_EXT);
    this.timed.push({ name, texels, start, query });
    this.poll();
  }

  private poll(): void {
    if (this.isPolling) return;
    this.isPolling = true;
    setTimeout(() => {
      this.isPolling = false;
      this.takeTimes();
      if (this.timed.length > 0) this.poll();
    }, 4);
  }

  private takeTimes(): void {
    const { gl, timer, timed } = this;
    if (this.device.lost) timed.length = 0;
    const isDisjoint = Boolean(gl.getParameter(timer!.GPU_DISJOINT_EXT)); // then the times mean nothing
    while (timed.length > 0 && gl.getQueryParameter(timed[0]!.query, gl.QUERY_RESULT_AVAILABLE)) {
      const { name, texels, start, query } = timed.shift()!;
      const milliseconds = (gl.getQueryParameter(query, gl.QUERY_RESULT) as number) / 1e6;
      gl.deleteQuery(query);
      if (isDisjoint) continue;
      const begin = Math.max(start, this.end);
      this.end = begin + milliseconds;
      this.measure('passes', name, begin, this.end, properties(texels, 'of the device'));
    }
  }
}

function properties(texels: number, time: string): [string, string][] {
  return [['texels', String(texels)], ['time', time]];
}
