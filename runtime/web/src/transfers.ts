// SPDX-License-Identifier: MIT
//
// Transfers to the host, which never block: each has a buffer of the device and a fence that is looked at now and then.
import { SkError } from './error.js';
import { wideOf, type Format, type HostArray } from './format.js';
import type { Rect } from './layout.js';
import type { Trace } from './trace.js';

/** What transfers are of. */
interface Source {
  readonly context: WebGL2RenderingContext;
  readonly tracer: Trace | null;
  takeErrors(): boolean;
  lostError(): SkError;
}

/** A transfer to the host that has been asked for. */
interface Readback {
  readonly buffer: WebGLBuffer;
  readonly sync: WebGLSync;
  /** Takes the bytes out of the buffer, which is bound. */
  readonly finish: () => void;
  readonly fail: (error: unknown) => void;
}

/** Bytes of a buffer for which it is worth asking whether the device has the memory: the answer takes as long as a small read. */
const largeBuffer = 2 ** 20;

function noMemory(): SkError {
  return new SkError('there is no memory for the elements that are read; read fewer at a time, as by a view', 'memory');
}

/** What `make` returns. Arrays that are too large for the page are errors of SkError's kind 'memory'. */
function orNoMemory<T>(make: () => T): T {
  try {
    return make();
  } catch (error) {
    throw error instanceof RangeError ? noMemory() : error;
  }
}

export class Transfers {
  private readonly gl: WebGL2RenderingContext;
  private readonly readFormats = new Map<number, { format: number; type: number }>();
  private readonly readbacks: Readback[] = [];
  private isPolling = false;

  constructor(private readonly device: Source) {
    this.gl = device.context;
  }

  /** Reads the texels of rectangles from the framebuffer, one after the other: channels of this format. */
  read(tight: Format, rects: readonly Rect[]): Promise<HostArray> {
    const { gl } = this;
    const wide = wideOf(tight);
    const isTight = this.readsTight(tight);
    const from = isTight ? { format: tight.format, type: tight.type, array: tight.channel, channels: tight.channels } : { ...wide, channels: 4 };
    const texels = texelsIn(rects);
    const asked = performance.now();
    const read = orNoMemory(() => new from.array(texels * from.channels));
    const isLarge = read.byteLength >= largeBuffer;
    if (isLarge) this.device.takeErrors(); // of earlier commands
    const buffer = gl.createBuffer()!;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, buffer);
    gl.bufferData(gl.PIXEL_PACK_BUFFER, read.byteLength, gl.STREAM_READ);
    if (isLarge && this.device.takeErrors()) {
      gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
      gl.deleteBuffer(buffer);
      throw noMemory();
    }
    gl.pixelStorei(gl.PACK_ALIGNMENT, 1);
    let at = 0;
    for (const { x, y, width, height } of rects) {
      gl.readPixels(x, y, width, height, from.format, from.type, at);
      at += width * height * from.channels * read.BYTES_PER_ELEMENT;
    }
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    return new Promise((resolve, reject) => {
      if (sync === null) return reject(this.device.lostError());
      const finish = () => {
        gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, read);
        this.device.tracer?.measure('transfers', `read ${read.byteLength} bytes`, asked);
        resolve(isTight ? read : orNoMemory(() => narrowed(read, tight, texels)));
      };
      this.readbacks.push({ buffer, sync, finish, fail: reject });
      this.poll();
    });
  }

  /** Rejects all transfers that are under way. */
  end(error: SkError): void {
    for (const { buffer, sync, fail } of this.readbacks.splice(0)) {
      this.gl.deleteBuffer(buffer);
      this.gl.deleteSync(sync);
      fail(error);
    }
  }

  /** Whether the driver reads such textures as they are; else it reads four channels of 32 bits. */
  private readsTight(format: Format): boolean {
    const wide = wideOf(format);
    if (format.format === wide.format && format.type === wide.type) return true;
    const { gl } = this;
    let own = this.readFormats.get(format.internal);
    if (own === undefined) {
      own = {
        format: gl.getParameter(gl.IMPLEMENTATION_COLOR_READ_FORMAT) as number,
        type: gl.getParameter(gl.IMPLEMENTATION_COLOR_READ_TYPE) as number,
      };
      this.readFormats.set(format.internal, own);
    }
    return own.format === format.format && own.type === format.type;
  }

  /** Looks at fences between other tasks of the page, until no transfer is left. */
  private poll(): void {
    if (this.isPolling) return;
    this.isPolling = true;
    const { gl } = this;
    const channel = new MessageChannel();
    const quick = 16;
    let looks = 0;
    const again = () => (++looks < quick ? channel.port2.postMessage(null) : setTimeout(look, 1));
    const look = () => {
      gl.flush(); // Chromium updates fences at each flush, otherwise only every 2 ms
      while (this.readbacks.length > 0) {
        const first = this.readbacks[0]!;
        const status = gl.clientWaitSync(first.sync, 0, 0);
        if (status === gl.TIMEOUT_EXPIRED) return again();
        this.readbacks.shift();
        if (status === gl.WAIT_FAILED || gl.isContextLost()) {
          first.fail(this.device.lostError()); // what is in the buffer is gone, whatever its fence has said
          continue;
        }
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, first.buffer);
        try {
          first.finish();
        } catch (error) {
          first.fail(error); // this read alone
        }
        gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
        gl.deleteBuffer(first.buffer);
        gl.deleteSync(first.sync);
      }
      this.isPolling = false;
      channel.port1.close();
    };
    channel.port1.onmessage = look;
    channel.port2.postMessage(null);
  }
}

export function texelsIn(rects: readonly Rect[]): number {
  return rects.reduce((count, { width, height }) => count + width * height, 0);
}

/** The channels of a texture from four channels of 32 bits. */
function narrowed(wide: HostArray, format: Format, texels: number): HostArray {
  const { channels } = format;
  const tight = new format.channel(texels * channels);
  for (let i = 0; i < texels; ++i) {
    for (let c = 0; c < channels; ++c) tight[i * channels + c] = wide[4 * i + c]!;
  }
  return tight;
}
