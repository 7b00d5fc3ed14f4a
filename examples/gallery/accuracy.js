// SPDX-License-Identifier: MIT
//
// What choices of accuracy cost on this device: time, and the error against doubles, which JavaScript computes in.

/** The largest difference, relative to the largest number of the reference. */
export function relativeError(got, wanted) {
  let most = 0;
  let scale = 0;
  for (let i = 0; i < wanted.length; ++i) {
    const difference = Math.abs(got[i] - wanted[i]);
    most = difference > most || Number.isNaN(difference) ? difference : most;
    scale = Math.max(scale, Math.abs(wanted[i]));
  }
  return scale > 0 ? most / scale : most;
}

/** Milliseconds, in two digits or more. */
export const milliseconds = (ms) => (ms < 100 ? ms.toPrecision(2) : ms.toFixed(0));

function shown(error) {
  if (error === 0) return '0';
  return error.toExponential(1).replace('e', ' · 10^').replace('+', '');
}

/** `1.2 · 10^-7` with a raised exponent. */
function power(text) {
  const [number, exponent] = text.split('^');
  const nodes = [number.replace('-', '−')];
  if (exponent !== undefined) nodes.push(Object.assign(document.createElement('sup'), { textContent: exponent.replace('-', '−') }));
  return nodes;
}

export class AccuracyPanel {
  /** `spec`: `note`, and `measure`, which yields rows { choice, ms, error, note }. */
  constructor(page, spec) {
    Object.assign(this, { page, spec, rows: document.getElementById('accuracy-rows'), button: document.getElementById('measure') });
    document.getElementById('accuracy-note').textContent = spec.note;
    this.button.onclick = () => this.run().catch((error) => page.fail(error));
  }

  async run() {
    const { page } = this;
    this.button.disabled = true;
    this.button.textContent = 'Measuring';
    this.rows.replaceChildren();
    try {
      await page.loop.aside(async () => {
        for await (const row of this.spec.measure(this.tools())) this.show(row);
      });
    } finally {
      this.button.textContent = 'Measure again';
      page.showButtons();
    }
  }

  tools() {
    const { device, fenceStream, simulation, settings } = this.page;
    /** Milliseconds of one call among many, whose results are waited for. */
    const time = async (work, least = settings.frames === null ? 60 : 5) => {
      work();
      await fenceStream.read();
      let count = 0;
      const start = performance.now();
      for (let round = 2; performance.now() - start < least; round = Math.min(2 * round, 256)) {
        for (let i = 0; i < round; ++i) work();
        count += round;
        await fenceStream.read();
      }
      return (performance.now() - start) / count;
    };
    /** The same for work that answers itself, such as a reduction. */
    const timeAnswer = async (work, times = settings.frames === null ? 8 : 2) => {
      await work();
      const start = performance.now();
      for (let i = 0; i < times; ++i) await work();
      return (performance.now() - start) / times;
    };
    return { device, simulation, time, timeAnswer };
  }

  show({ choice, ms, error, note }) {
    const row = this.rows.insertRow();
    const name = row.insertCell();
    name.textContent = choice;
    if (note !== undefined) name.append(Object.assign(document.createElement('small'), { textContent: note }));
    row.insertCell().textContent = milliseconds(ms);
    row.insertCell().append(...power(shown(error)));
    Object.assign(row.dataset, { ms, error });
  }
}
