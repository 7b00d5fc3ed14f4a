// SPDX-License-Identifier: MIT
//
// Elements of the page, and numbers as text. Text from the report only ever becomes a text node, never HTML.
"use strict";

/** This page shows reports of this version alone. */
const isReadable = report?.format === "streamkernel-shadow" && report.version === 1;

/** An element with attributes and children; false, null and undefined children are left out. */
function make(name, attributes, ...children) {
  return fill(document.createElement(name), attributes, children);
}

function makeSvg(name, attributes, ...children) {
  return fill(document.createElementNS("http://www.w3.org/2000/svg", name), attributes, children);
}

function fill(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes ?? {})) {
    if (key.startsWith("on")) element.addEventListener(key.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) element.setAttribute(key, value === true ? "" : value);
  }
  element.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** A list with a button that shows `step` more, or with nothing if nothing is left. */
function moreButton(left, step, of, show) {
  return left > 0 ? [make("button", { type: "button", onclick: show }, `Show ${countText(Math.min(left, step))} more of ${of}`)] : [];
}

const narrowSpace = "\u202f";
const missing = "\u2013";

/** A number of the report, where those that are not finite are texts. */
function toNumber(value) {
  if (typeof value === "number") return value;
  if (value === "inf") return Infinity;
  return value === "-inf" ? -Infinity : NaN;
}

/** Puts numbers in descending order: NaN and infinity, the worst errors, first; what is missing last. */
function severity(value) {
  if (value === null || value === undefined) return -Infinity;
  const number = toNumber(value);
  return Number.isNaN(number) ? Infinity : number;
}

function superscript(integer) {
  return String(integer).replace(/[-0-9]/g, (sign) =>
    sign === "-" ? "\u207b" : "\u2070\u00b9\u00b2\u00b3\u2074\u2075\u2076\u2077\u2078\u2079"[sign],
  );
}

const powerOfTen = (exponent) => `10${superscript(exponent)}`;

function notFinite(number) {
  return Number.isNaN(number) ? "NaN" : number > 0 ? "\u221e" : "\u2212\u221e";
}

/** Two significant digits: 0.82, 1.3 × 10⁻⁷. */
function errorText(value) {
  if (value === null || value === undefined) return missing;
  const number = toNumber(value);
  if (!Number.isFinite(number)) return notFinite(number);
  if (number === 0) return "0";
  const size = Math.abs(number);
  if (size >= 0.01 && size < 1000) return String(Number(number.toPrecision(2)));
  const [mantissa, exponent] = number.toExponential(1).split("e");
  return `${mantissa.replace("-", "\u2212")}${narrowSpace}\u00d7${narrowSpace}${powerOfTen(Number(exponent))}`;
}

const countText = (count) => (typeof count === "number" ? String(count).replace(/\B(?=(\d{3})+$)/g, narrowSpace) : missing);

/** "1 call", "3 calls". */
const counted = (count, noun) => `${countText(count)} ${noun}${count === 1 ? "" : "s"}`;

function timeText(value) {
  if (value === null || value === undefined) return missing;
  const seconds = toNumber(value);
  if (!Number.isFinite(seconds)) return notFinite(seconds);
  if (seconds === 0) return "0 s";
  const [scale, unit] = seconds >= 1 ? [1, "s"] : seconds >= 1e-3 ? [1e3, "ms"] : [1e6, "\u00b5s"];
  const digits = seconds * scale;
  return `${digits >= 100 ? Math.round(digits) : Number(digits.toPrecision(2))}${narrowSpace}${unit}`;
}

function percentText(value) {
  if (value === null || value === undefined) return missing;
  const percent = 100 * toNumber(value);
  if (!Number.isFinite(percent)) return notFinite(percent);
  if (percent === 0) return `0${narrowSpace}%`;
  if (percent < 0.1) return `<${narrowSpace}0.1${narrowSpace}%`;
  if (percent > 99.9 && percent < 100) return `>${narrowSpace}99.9${narrowSpace}%`;
  return `${percent < 10 ? percent.toFixed(1) : Math.round(percent)}${narrowSpace}%`;
}

/** Puts the fewest surviving digits last; without any number there are none. */
function digitsKey(value) {
  const digits = toNumber(value);
  return Number.isNaN(digits) ? -Infinity : digits;
}

/** Decimal digits that survive. */
function digitsText(value) {
  if (value === null || value === undefined) return missing;
  const digits = toNumber(value);
  if (digits === Infinity) return "all";
  return digits > 0 ? digits.toFixed(1) : "none";
}

const elementText = (output, element) => output + (element ?? []).map((index) => `[${index}]`).join("");

/** A value of an element: a number, or a text for one that is not finite or no single number. */
function valueText(value) {
  if (typeof value === "number") return String(value).replace("-", "\u2212");
  if (Array.isArray(value)) return `(${value.map(valueText).join(", ")})`;
  return { nan: "NaN", inf: "\u221e", "-inf": "\u2212\u221e" }[value] ?? String(value ?? missing);
}

/** A value in decimal, with its bits in hexadecimal. */
function valueOf(sample) {
  if (!sample) return missing;
  const value = make("span", { class: "value" }, valueText(sample.value));
  return sample.hex && sample.hex !== String(sample.value) ? [value, " ", make("span", { class: "hex" }, sample.hex)] : [value];
}

/** How often each kind of exceptional value occurs: "3 NaN, 1 flushed". */
function exceptionsText(kernel) {
  const parts = [
    [kernel.nans, "NaN"],
    [kernel.infinities, "\u221e"],
    [kernel.flushed, "flushed"],
  ].filter(([count]) => count);
  return parts.map(([count, what]) => `${countText(count)} ${what}`).join(", ") || "0";
}

const kindNames = {
  nan: "NaN",
  infinity: "Infinity",
  flush: "Flush to zero",
  decision: "Decision",
  unstable: "Unstable",
  error: "Error",
  storage: "Storage",
  fine: "Fine",
  nothing: "Nothing followed",
};
const nameOfKind = (kind) => kindNames[kind] ?? kind;

/** Wraps long qualified names after their colons. */
function nameText(name) {
  return String(name ?? "")
    .split(/(?<=::)/)
    .flatMap((part, i) => (i ? [make("wbr"), part] : [part]));
}
