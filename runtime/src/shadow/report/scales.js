// SPDX-License-Identifier: MIT
//
// Where calls and errors are in a chart: ranges, ticks, and points thinned to what can be seen. Errors of 0 and errors that are not
// finite have bands of their own, below and above the logarithmic scale.
"use strict";

const chartHeight = 272;
const margin = { left: 58, right: 16, top: 40, bottom: 42 };
const bandHeight = 20; // for what is not finite
const zeroHeight = 28; // for zeros

/** The rounding unit of an element's type: the largest relative error of one rounding. */
function unitOf(type) {
  const scalar = String(type ?? "").replace(/\d+(x\d+)?$/, "");
  return { half: 11, float: 24, double: 53 }[scalar] ?? null;
}

/** Splits points [call, value] into runs of one kind: positive, zero, notFinite. */
function runsOf(points) {
  const runs = [];
  for (const [call, value] of points) {
    const kind = !Number.isFinite(value) ? "notFinite" : value > 0 ? "positive" : "zero";
    if (runs.at(-1)?.kind !== kind) runs.push({ kind, points: [] });
    runs.at(-1).points.push([call, value]);
  }
  return runs;
}

/** At most four points for each pixel: the first, the least, the largest and the last. */
function thinned(pixels) {
  const kept = [];
  for (let from = 0; from < pixels.length;) {
    let to = from,
      least = from,
      largest = from;
    for (; to < pixels.length && Math.floor(pixels[to][0]) === Math.floor(pixels[from][0]); ++to) {
      if (pixels[to][1] < pixels[least][1]) least = to;
      if (pixels[to][1] > pixels[largest][1]) largest = to;
    }
    for (const i of [...new Set([from, least, largest, to - 1])].sort((a, b) => a - b)) kept.push(pixels[i]);
    from = to;
  }
  return kept;
}

/** The range of all errors in these charts, as powers of ten, and whether there are zeros and values that are not finite. */
function rangeOf(charts) {
  const range = { low: Infinity, high: -Infinity, hasZero: false, hasNotFinite: false };
  for (const { lines } of charts) {
    for (const { points } of lines) {
      for (const [, value] of points) {
        if (!Number.isFinite(value)) range.hasNotFinite = true;
        else if (value <= 0) range.hasZero = true;
        else {
          range.low = Math.min(range.low, value);
          range.high = Math.max(range.high, value);
        }
      }
    }
  }
  range.high = range.high > 0 ? Math.ceil(Math.log10(range.high)) : 0;
  range.low = Number.isFinite(range.low) ? Math.max(Math.floor(Math.log10(0.9 * range.low)), range.high - 30) : range.high - 3;
  if (range.high - range.low < 2) range.low = range.high - 2;
  return range;
}

/** Round numbers between two calls. */
function callTicks(low, high, isLog, count) {
  const ticks = [];
  if (isLog) {
    const factors = high / low > 200 ? [1] : [1, 2, 5];
    for (let power = 10 ** Math.floor(Math.log10(low)); power <= high; power *= 10) {
      for (const factor of factors) if (power * factor >= low && power * factor <= high) ticks.push(power * factor);
    }
    const every = Math.ceil(ticks.length / count);
    return ticks.filter((_, i) => i % every === 0);
  }
  const raw = (high - low) / count,
    power = 10 ** Math.floor(Math.log10(raw || 1));
  const step = Math.max(1, [1, 2, 5, 10].map((factor) => factor * power).find((one) => one >= raw) ?? 1);
  for (let tick = Math.ceil(low / step) * step; tick <= high; tick += step) ticks.push(tick);
  return ticks;
}

/** Where calls and errors are in a chart of some width. */
function scalesOf(width, calls, range, isLog) {
  const right = width - margin.right,
    bottom = chartHeight - margin.bottom;
  const low = isLog ? Math.max(1, calls.low) : calls.low,
    high = Math.max(calls.high, low + 1);
  const place = isLog ? (call) => Math.log(Math.max(call, low)) : (call) => call;
  const top = margin.top + (range.hasNotFinite ? bandHeight + 8 : 0);
  const floor = bottom - (range.hasZero ? zeroHeight : 0);
  return {
    low,
    high,
    right,
    bottom,
    top,
    floor,
    x: (call) => margin.left + ((place(call) - place(low)) / (place(high) - place(low))) * (right - margin.left),
    y(value) {
      if (!Number.isFinite(value)) return margin.top + bandHeight / 2;
      if (value <= 0) return bottom - zeroHeight / 2;
      const at = Math.min(1, Math.max(0, (Math.log10(value) - range.low) / (range.high - range.low)));
      return floor - at * (floor - top);
    },
  };
}
