// SPDX-License-Identifier: MIT
//
// Errors over calls: the charts of streams and of kernels' outputs.
"use strict";

/** Why a chart has vertical lines: the first exceptional values and decisions, of one kernel's output or of the program. */
function firstMarks(isMine, withKernel) {
  const first = new Map();
  const note = (kind, event) => {
    if (isMine(event) && (!first.has(kind) || event.call < first.get(kind).call)) first.set(kind, event);
  };
  for (const event of report.exceptions ?? []) note(event.kind, event);
  for (const event of report.decisions ?? []) note("decision", event);
  const names = { nan: "NaN", infinity: "\u221e", flush: "flush", decision: "decision" };
  return [...first].map(([kind, { call, kernel }]) => ({
    call,
    kind,
    text: `${names[kind] ?? kind}${withKernel ? ` in ${kernel.split("::").at(-1)}` : ""}`,
  }));
}

const callsOf = (points, at) => points.map((point) => [point[0], toNumber(point[at])]);

function chartOfOutput(kernel, output) {
  const points = output.points ?? [];
  return {
    name: `${kernel.name}, ${output.name}`,
    type: output.type,
    note: output.type,
    lines: [
      { key: "total", at: 3 },
      { key: "inherited", at: 2 },
      { key: "own", at: 1 },
    ].map(({ key, at }) => ({ key, label: key, points: callsOf(points, at) })),
    marks: firstMarks((event) => event.kernel === kernel.name && event.output === output.name, false),
  };
}

function chartOfStream(stream, marks) {
  const shape = (stream.shape ?? []).join(" \u00d7 ");
  const resyncs = stream.resyncs
    ? `, taken from the device again ${stream.resyncs === 1 ? "once" : `${countText(stream.resyncs)} times`}`
    : "";
  return {
    name: stream.name,
    type: stream.type,
    note: `${stream.type ?? ""}${shape && ` of ${shape}`}${resyncs}`,
    lines: [{ key: "total", label: "total", points: callsOf(stream.points ?? [], 1) }],
    marks,
  };
}

const worstTotal = (chart) => chart.lines[0].points.reduce((worst, [, value]) => Math.max(worst, severity(value)), -1);

/** Charts in a grid: a dozen at first, each drawn when it comes into view. */
function chartGrid(charts, settings) {
  const grid = make("div", { class: "charts" });
  const seen = new IntersectionObserver(
    (entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting || target.isDrawn) continue;
        target.isDrawn = true;
        target.draw(settings);
      }
    },
    { rootMargin: "400px" },
  );
  grid.show = (some) => {
    seen.disconnect();
    grid.replaceChildren(...some.map((chart) => (chart.figure ??= chartFigure(chart))));
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
  let low = Infinity,
    high = -Infinity;
  for (const { lines } of charts) {
    for (const { points } of lines) {
      if (points.length) ((low = Math.min(low, points[0][0])), (high = Math.max(high, points.at(-1)[0])));
    }
  }
  return high < low ? { low: 0, high: Math.max(1, report.calls ?? 1) } : { low, high };
}

/** Error over calls of every stream and of every output of a kernel. */
function picturesSection() {
  const ofProgram = firstMarks(() => true, true);
  const kinds = [
    { name: "streams", noun: "stream", charts: (report.streams ?? []).map((stream) => chartOfStream(stream, ofProgram)) },
    {
      name: "kernels\u2019 outputs",
      noun: "output",
      charts: (report.kernels ?? []).flatMap((kernel) => (kernel.outputs ?? []).map((output) => chartOfOutput(kernel, output))),
    },
  ]
    .map((kind) => ({ ...kind, charts: kind.charts.filter(({ lines }) => lines[0].points.length) }))
    .filter(({ charts }) => charts.length);
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
    const found = state.filter
      ? state.kind.charts.filter(({ name }) => name.toLowerCase().includes(state.filter))
      : state.kind.charts;
    grid.show(found.slice(0, state.shown));
    keys.replaceChildren(...(state.kind.noun === "stream" ? [] : [legend()]));
    const left = found.length - state.shown;
    foot.replaceChildren(
      ...moreButton(left, 24, counted(found.length, state.kind.noun), () => {
        state.shown += 24;
        draw();
      }),
      found.length ? "" : `No ${state.kind.noun} contains \u201c${state.filter}\u201d.`,
    );
  };
  const isMany = kinds.some(({ charts }) => charts.length > few);
  const body = [
    make(
      "div",
      { class: "controls" },
      kinds.length > 1 &&
        choice(
          "kind",
          "Errors of",
          kinds.map(({ name, charts }) => `${name} (${countText(charts.length)})`),
          (i) => {
            state.kind = kinds[i];
            state.shown = few;
            draw();
          },
        ),
      choice("calls", "Calls", ["linear", "logarithmic"], (i) => {
        settings.isLog = i === 1;
        grid.redraw();
      }),
      choice("errors", "Scale of errors", ["the same for all", "each its own"], (i) => {
        settings.range = i === 0 ? shared : null;
        grid.redraw();
      }),
      isMany &&
        filterField("name", (text) => {
          state.filter = text;
          state.shown = few;
          draw();
        }),
    ),
    keys,
    grid,
    foot,
  ];
  draw();
  return section(
    "pictures",
    "Error over calls",
    "The largest errors first. Vertical lines show the first value of each kind that a double would not have, and the first decision that differs. Point at a chart, or use the arrow keys in it, for numbers.",
    body,
  );
}
