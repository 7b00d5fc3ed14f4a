// SPDX-License-Identifier: MIT
//
// The table by kernel, whose rows open, and the charts of errors over calls.
"use strict";

const finest = 7.2;  // decimal digits of float; the scale of the bars of digits, unless something has more

/** Why a chart has vertical lines: the first exceptional values and decisions, of one kernel's output or of the program. */
function firstMarks(isMine, withKernel) {
  const first = new Map();
  const note = (kind, event) => {
    if (isMine(event) && (!first.has(kind) || event.call < first.get(kind).call)) first.set(kind, event);
  };
  for (const event of report.exceptions ?? []) note(event.kind, event);
  for (const event of report.decisions ?? []) note("decision", event);
  const names = { nan: "NaN", infinity: "\u221e", flush: "flush", decision: "decision" };
  return [...first].map(([kind, { call, kernel }]) => ({ call, kind, text: `${names[kind] ?? kind}${withKernel ? ` in ${kernel.split("::").at(-1)}` : ""}` }));
}

const callsOf = (points, at) => points.map((point) => [point[0], toNumber(point[at])]);

function chartOfOutput(kernel, output) {
  const points = output.points ?? [];
  return {
    name: `${kernel.name}, ${output.name}`, type: output.type, note: output.type,
    lines: [{ key: "total", at: 3 }, { key: "inherited", at: 2 }, { key: "own", at: 1 }].map(({ key, at }) => ({ key, label: key, points: callsOf(points, at) })),
    marks: firstMarks((event) => event.kernel === kernel.name && event.output === output.name, false),
  };
}

function chartOfStream(stream, marks) {
  const shape = (stream.shape ?? []).join(" \u00d7 ");
  const resyncs = stream.resyncs ? `, taken from the device again ${stream.resyncs === 1 ? "once" : `${countText(stream.resyncs)} times`}` : "";
  return {
    name: stream.name, type: stream.type, note: `${stream.type ?? ""}${shape && ` of ${shape}`}${resyncs}`,
    lines: [{ key: "total", label: "total", points: callsOf(stream.points ?? [], 1) }], marks,
  };
}

const worstTotal = (chart) => chart.lines[0].points.reduce((worst, [, value]) => Math.max(worst, severity(value)), -1);

/** Charts in a grid: a dozen at first, each drawn when it comes into view. */
function chartGrid(charts, settings) {
  const grid = make("div", { class: "charts" });
  const seen = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting || target.isDrawn) continue;
      target.isDrawn = true;
      target.draw(settings);
    }
  }, { rootMargin: "400px" });
  grid.show = (some) => {
    seen.disconnect();
    grid.replaceChildren(...some.map((chart) => chart.figure ??= chartFigure(chart)));
    grid.redraw();
  };
  grid.redraw = () => {
    seen.disconnect();
    for (const figure of grid.children) {
      figure.isDrawn = false;
      seen.observe(figure);
    }
  };
  grid.drawAll = () => {
    for (const figure of grid.children) figure.draw(settings);
  };
  let width = 0;
  new ResizeObserver(([{ contentRect }]) => {
    if (width && contentRect.width !== width) grid.redraw();
    width = contentRect.width;
  }).observe(grid);
  addEventListener("beforeprint", grid.drawAll);
  grid.show(charts);
  return grid;
}

/** The first and last call that a point of these charts is of. */
function callRange(charts) {
  let low = Infinity, high = -Infinity;
  for (const { lines } of charts) {
    for (const { points } of lines) {
      if (points.length) low = Math.min(low, points[0][0]), high = Math.max(high, points.at(-1)[0]);
    }
  }
  return high < low ? { low: 0, high: Math.max(1, report.calls ?? 1) } : { low, high };
}

/** Part (d): error over calls of every stream and of every output of a kernel. */
function picturesSection() {
  const ofProgram = firstMarks(() => true, true);
  const kinds = [
    { name: "streams", noun: "stream", charts: (report.streams ?? []).map((stream) => chartOfStream(stream, ofProgram)) },
    { name: "kernels\u2019 outputs", noun: "output", charts: (report.kernels ?? []).flatMap((kernel) => (kernel.outputs ?? []).map((output) => chartOfOutput(kernel, output))) },
  ].map((kind) => ({ ...kind, charts: kind.charts.filter(({ lines }) => lines[0].points.length) })).filter(({ charts }) => charts.length);
  if (!kinds.length) return null;
  for (const { charts } of kinds) {
    const worst = new Map(charts.map((chart) => [chart, worstTotal(chart)]));
    charts.sort((a, b) => worst.get(b) - worst.get(a));
  }
  const all = kinds.flatMap(({ charts }) => charts);
  const shared = rangeOf(all);
  const settings = { calls: callRange(all), range: shared, isLog: false };
  const few = 6;
  const state = { kind: kinds[0], shown: few, filter: "" };
  const grid = chartGrid([], settings);
  const foot = make("p", { class: "more" });
  const keys = make("div");
  const draw = () => {
    const found = state.filter ? state.kind.charts.filter(({ name }) => name.toLowerCase().includes(state.filter)) : state.kind.charts;
    grid.show(found.slice(0, state.shown));
    keys.replaceChildren(...(state.kind.noun === "stream" ? [] : [legend()]));
    const left = found.length - state.shown;
    foot.replaceChildren(...(left > 0 ? [make("button", { type: "button", onclick: () => { state.shown += 24; draw(); } }, `Show ${Math.min(24, left)} more of ${counted(found.length, state.kind.noun)}`)] : []),
      found.length ? "" : `No ${state.kind.noun} contains \u201c${state.filter}\u201d.`);
  };
  const isMany = kinds.some(({ charts }) => charts.length > few);
  const body = [
    make("div", { class: "controls" },
      kinds.length > 1 && choice("kind", "Errors of", kinds.map(({ name, charts }) => `${name} (${countText(charts.length)})`), (i) => { state.kind = kinds[i]; state.shown = few; draw(); }),
      choice("calls", "Calls", ["linear", "logarithmic"], (i) => { settings.isLog = i === 1; grid.redraw(); }),
      choice("errors", "Scale of errors", ["the same for all", "each its own"], (i) => { settings.range = i === 0 ? shared : null; grid.redraw(); }),
      isMany && filterField("name", (text) => { state.filter = text; state.shown = few; draw(); })),
    keys, grid, foot];
  draw();
  return section("pictures", "Error over calls",
    "The largest errors first. Vertical lines show the first value of each kind that a double would not have, and the first decision that differs. Point at a chart, or use the arrow keys in it, for numbers.",
    body);
}

/** A kernel's largest and typical errors. */
function errorsTable(kernel) {
  const rows = [["own", kernel.own], ["of it, storing", kernel.storage], ["inherited", kernel.inherited], ["total", kernel.total]];
  const amplification = kernel.amplification;
  return make("table", { class: "small" },
    make("thead", {}, make("tr", {}, ["error", "largest", "typical"].map((name, i) => make("th", { scope: "col", class: i && "number" }, name)))),
    make("tbody", {}, rows.filter(([, error]) => error).map(([name, error]) => make("tr", {},
      make("th", { scope: "row" }, lineKinds.some(({ key }) => key === name) && make("i", { class: `key ${name}` }), name),
      make("td", { class: "number" }, errorText(error.largest)), make("td", { class: "number" }, errorText(error.typical)))),
    amplification && make("tr", { class: "apart" }, make("th", { scope: "row" }, "amplification"),
      make("td", { class: "number" }, errorText(amplification.largest)), make("td", { class: "number" }, errorText(amplification.typical)))));
}

function worstElement({ worst }) {
  if (!worst) return make("p", { class: "note" }, "No element differs from the reference.");
  return [
    make("p", {}, make("span", { class: "code" }, elementText(worst.output, worst.element)), ` of call ${countText(worst.call)} is `, valueOf(worst.device), ", and should be ", valueOf(worst.reference), "."),
    inputsTable(worst.inputs)];
}

/** What a row shows when it opens. */
function kernelDetails(kernel) {
  const charts = (kernel.outputs ?? []).filter(({ points }) => points?.length).map((output) => chartOfOutput(kernel, output));
  const settings = { calls: callRange(charts), range: null, isLog: false };
  const few = 4;
  const missingCalls = (kernel.calls ?? 0) - (kernel.followed ?? 0);
  return make("div", { class: "details" },
    make("div", { class: "sides" },
      make("div", {}, make("h4", {}, "Error of its calls"), errorsTable(kernel),
        missingCalls > 0 && make("p", { class: "note" }, `${countText(kernel.followed)} of ${counted(kernel.calls, "call")} ran beside the reference.`)),
      make("div", {}, make("h4", {}, "Its worst element"), worstElement(kernel))),
    charts.length > 0 && [make("h4", {}, "Error over its calls"), legend(), chartGrid(charts.slice(0, few), settings)],
    charts.length > few && make("p", { class: "note" }, `${counted(charts.length - few, "other output")} in \u201cError over calls\u201d.`));
}

/** Part (c): the table by kernel. */
function kernelsSection() {
  const kernels = report.kernels ?? [];
  if (!kernels.length) return section("kernels", "Kernels", null, make("p", {}, "The program called no kernel."));
  const digitsScale = Math.max(finest, ...kernels.map(({ digits }) => toNumber(digits)).filter(Number.isFinite));
  const number = (name, title, key, of) => ({ name, title, isNumber: true, key, of });
  const exceptional = (kernel) => (kernel.nans ?? 0) + (kernel.infinities ?? 0) + (kernel.flushed ?? 0);
  const sorted = (of) => (kernel) => severity(of(kernel));
  const errors = (name, title, of) => ({ name, title, isNumber: true, key: sorted(of), of: (kernel) => errorText(of(kernel)) });
  const columns = [
    { name: "kernel", key: ({ name }) => name, of: (kernel) => make("button", { type: "button", class: "opens code", "aria-expanded": "false" }, nameText(kernel.name)) },
    { name: "share", title: "How much of the error of all results its own errors cause", isNumber: true, key: sorted(({ share }) => share),
      of: ({ share }) => metered(toNumber(share), "share", percentText(share)) },
    { name: "digits", title: "Decimal digits that survive", isNumber: true, key: ({ digits }) => digitsKey(digits),
      of: ({ digits }) => metered(toNumber(digits) / digitsScale, "digits", digitsText(digits)) },
    errors("own", "The largest error that a call adds, from the device\u2019s own inputs", ({ own }) => own?.largest),
    errors("inherited", "The largest error that its inputs bring", ({ inherited }) => inherited?.largest),
    errors("amplification", "Inherited error over the error of the inputs, at most", ({ amplification }) => amplification?.largest),
    number("calls", "How often it ran", ({ calls }) => calls ?? 0, ({ calls }) => countText(calls)),
    number("time", "Time of all of its calls on the device", ({ seconds }) => seconds ?? 0, ({ seconds }) => timeText(seconds)),
    number("exceptions", "NaN, infinities and values flushed to zero that the reference does not have", exceptional,
      (kernel) => make("span", { class: (kernel.nans || kernel.infinities) && "bad" }, exceptionsText(kernel))),
    number("decisions", "Elements that decide differently from the reference", ({ decisions }) => decisions ?? 0,
      ({ decisions }) => make("span", { class: decisions && "warn" }, countText(decisions ?? 0))),
  ];
  const open = (row, more, button, isOpen) => {
    if (isOpen && !more.firstChild.firstChild) more.firstChild.append(kernelDetails(more.kernel));
    more.hidden = !isOpen;
    button.setAttribute("aria-expanded", String(isOpen));
    row.classList.toggle("open", isOpen);
  };
  const list = table(columns, kernels, {
    most: 25, sort: 1, noun: "kernel", caption: "Kernels", filter: ({ name }) => name,
    row(row, kernel) {
      const more = make("tr", { hidden: true, class: "more" }, make("td", { colspan: columns.length }));
      more.kernel = kernel;
      const button = row.querySelector("button");
      row.id = `kernel-${kernelIndex.get(kernel.name)}`;
      row.classList.add("can-open");
      row.addEventListener("click", (event) => (event.target.closest("a") || getSelection().toString() ? null : open(row, more, button, more.hidden)));
      row.open = () => open(row, more, button, true);
      return [row, more];
    },
  });
  const visit = () => {
    const index = /^#kernel-(\d+)$/.exec(location.hash)?.[1];
    if (index === undefined || !kernels[index]) return;
    const [row] = list.reveal(kernels[index]);
    row.open();
    row.scrollIntoView({ block: "start" });
  };
  addEventListener("hashchange", visit);
  addEventListener("click", (event) => event.target.closest?.("a")?.hash === location.hash && visit());
  setTimeout(visit);
  return section("kernels", "Kernels",
    "A call\u2019s own error is what it adds to exact inputs; what its inputs bring is inherited. A row opens to the kernel\u2019s worst element and its charts.",
    list);
}
