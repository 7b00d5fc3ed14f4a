// SPDX-License-Identifier: MIT
//
// The benchmark's work in gpu.js: the same numbers, on textures that stay on the device, in 32-bit floats. Kernels are written as its
// documents do it. The sum takes two kernels, each of which adds 8 x 8 numbers, and the host adds the last 16 x 16; one thread for each row
// would leave a GPU idle. `sumOnHost` reads all elements, which takes no kernel. gpu.js has no sums of its own, and both add plainly.

const shared = { pipeline: true, precision: 'single', tactic: 'precision' };

/** saxpy and heat take how many calls, and return a function that waits for the last one and gives a number of it. */
export function gpuJs(GPU, n, x, y) {
  const gpu = new GPU({ mode: 'gpu' });
  const kernel = (code, output, constants = {}) => gpu.createKernel(code, { ...shared, output, constants });
  const upload = () => kernel(function (a) { return a[this.thread.y][this.thread.x]; }, [n, n]);
  const rows = (data) => Array.from({ length: n }, (_, i) => data.subarray(i * n, (i + 1) * n));
  const [xs, ys] = [upload()(rows(x)), upload()(rows(y))];
  const saxpy = kernel(function (a, x, y) { return a * x[this.thread.y][this.thread.x] + y[this.thread.y][this.thread.x]; }, [n, n]);
  const diffuse = kernel(function (k, u) {
    const x = this.thread.x;
    const y = this.thread.y;
    const last = this.constants.n - 1;
    const west = x > 0 ? x - 1 : last;
    const east = x < last ? x + 1 : 0;
    const south = y > 0 ? y - 1 : last;
    const north = y < last ? y + 1 : 0;
    const here = u[y][x];
    return here + k * (u[y][east] + u[y][west] + u[north][x] + u[south][x] - 4 * here);
  }, [n, n], { n }).setImmutable(true);
  const fold = (size) => kernel(function (u) {
    let total = 0;
    for (let j = 0; j < 8; j++) {
      for (let i = 0; i < 8; i++) total += u[this.thread.y * 8 + j][this.thread.x * 8 + i];
    }
    return total;
  }, [size, size]);
  const folds = [fold(n / 8), fold(n / 64)];
  const element = gpu.createKernel(function (u) { return u[this.thread.x][this.thread.x]; }, { output: [1], precision: 'single' });
  const first = (texture) => () => element(texture)[0];
  return {
    saxpy(count) {
      let last;
      for (let i = 0; i < count; ++i) last = saxpy(2, xs, ys);
      return first(last);
    },
    heat(count) {
      let u = xs;
      for (let i = 0; i < count; ++i) {
        const next = diffuse(0.2, u);
        if (u !== xs) u.delete();
        u = next;
      }
      return () => {
        const value = first(u)();
        u.delete();
        return value;
      };
    },
    sum: () => folds[1](folds[0](xs)).toArray().reduce((sum, row) => row.reduce((a, b) => a + b, sum), 0),
    sumOnHost: () => xs.toArray().reduce((sum, row) => row.reduce((a, b) => a + b, sum), 0),
    dispose: () => gpu.destroy(),
  };
}
