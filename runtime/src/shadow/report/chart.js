// SPDX-License-Identifier: MIT
//
// A chart of errors over calls, drawn as SVG for the width that there is, which tells its numbers to the pointer and to arrow keys.
"use strict";

/** The lines that a point may have, in the order in which they are drawn. */
const lineKinds = [
  { key: "total", label: "total" },
  { key: "inherited", label: "inherited" },
  { key: "own", label: "own" },
];

function axesOf(scales, range, isLog, unit) {
  const { right, bottom, top, floor, x, y } = scales;
  const parts = [];
  const label = (at, up, text, anchor, kind) =>
    parts.push(makeSvg("text", { x: at, y: up, "text-anchor": anchor, class: kind ?? "tick" }, text));
  const line = (x1, y1, x2, y2, kind) => parts.push(makeSvg("line", { x1, y1, x2, y2, class: kind }));
  const step = Math.max(1, Math.ceil((range.high - range.low) / 6));
  for (let power = range.high; power >= range.low; power -= step) {
    line(margin.left, y(10 ** power), right, y(10 ** power), "grid");
    label(margin.left - 8, y(10 ** power) + 4, power === 0 ? "1" : powerOfTen(power), "end");
  }
  if (range.hasZero) {
    if ((range.high - range.low) % step) line(margin.left, floor, right, floor, "grid");
    label(margin.left - 8, bottom - zeroHeight / 2 + 4, "0", "end");
  }
  if (range.hasNotFinite) {
    parts.unshift(
      makeSvg("rect", { x: margin.left, y: margin.top, width: right - margin.left, height: bandHeight, class: "band" }),
    );
    label(margin.left - 8, margin.top + bandHeight / 2 + 4, "NaN, \u221e", "end");
  }
  const unitError = unit === null ? 0 : 2 ** -unit;
  if (unit !== null && unitError > 10 ** range.low && unitError < 10 ** range.high) {
    line(margin.left, y(unitError), right, y(unitError), "unit");
    label(right, y(unitError) - 5, `rounding unit 2${superscript(-unit)}`, "end", "unit");
  }
  for (const tick of callTicks(scales.low, scales.high, isLog, Math.max(2, Math.floor((right - margin.left) / 80)))) {
    line(x(tick), bottom, x(tick), bottom + 4, "axis");
    label(x(tick), bottom + 17, countText(tick), "middle");
  }
  line(margin.left, bottom, right, bottom, "axis");
  label((margin.left + right) / 2, chartHeight - 6, "call", "middle", "name");
  label(margin.left - 8, margin.top - 10, "error", "end", "name");
  return parts;
}

function lineOf({ key, points }, scales) {
  const parts = [];
  for (const { kind, points: run } of runsOf(points)) {
    const pixels = thinned(run.map(([call, value]) => [scales.x(call), scales.y(value)]));
    const path = pixels.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");
    if (pixels.length > 1) parts.push(makeSvg("path", { d: path, class: `line ${key} ${kind}` }));
    if (pixels.length === 1 || (points.length <= 30 && kind !== "notFinite")) {
      for (const [cx, cy] of pixels)
        parts.push(
          makeSvg("circle", { cx: cx.toFixed(1), cy: cy.toFixed(1), r: key === "total" ? 3.2 : 2.2, class: `dot ${key}` }),
        );
    }
  }
  return parts;
}

/** Vertical lines where something happened first; their texts take two rows if they are close. */
function marksOf(marks, scales) {
  const ends = [-Infinity, -Infinity];
  return [...marks]
    .sort((a, b) => a.call - b.call)
    .filter(({ call }) => call >= scales.low && call <= scales.high)
    .map(({ call, kind, text }) => {
      const at = scales.x(call),
        width = 7.4 * text.length;
      const isLeft = at + width > scales.right;
      const start = isLeft ? at - width : at;
      const row = ends[0] + 6 < start ? 0 : 1;
      ends[row] = Math.max(ends[row], start + width);
      const up = row === 0 ? margin.top - 8 : margin.top - 24;
      return makeSvg(
        "g",
        { class: `mark ${kind}` },
        makeSvg("line", { x1: at, x2: at, y1: up - 6, y2: scales.bottom }),
        makeSvg("text", { x: isLeft ? at - 4 : at + 4, y: up, "text-anchor": isLeft ? "end" : "start" }, text),
      );
    });
}

/** What a chart says to those who do not see it. */
function summaryOf(chart) {
  const told = chart.lines
    .filter(({ points }) => points.length)
    .map(({ label, points }) => {
      const worst = points.reduce((a, b) => (severity(b[1]) > severity(a[1]) ? b : a));
      return `${label} error ${errorText(points[0][1])} in call ${points[0][0]}, ${errorText(points.at(-1)[1])} in call ${points.at(-1)[0]}, at most ${errorText(worst[1])} in call ${worst[0]}`;
    });
  return [`${chart.name}, error over calls`, ...told, ...chart.marks.map(({ call, text }) => `${text} in call ${call}`)].join(
    "; ",
  );
}

/** The index of the point that is nearest to a place on a monotonic scale, of points in the order of calls. */
function nearestPoint(points, scale, goal) {
  let low = 0,
    high = points.length - 1;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (scale(points[middle][0]) < goal) low = middle + 1;
    else high = middle;
  }
  return low > 0 && goal - scale(points[low - 1][0]) < scale(points[low][0]) - goal ? low - 1 : low;
}

/** The numbers of a chart as a table, which is built when it is opened. */
function numbersOf(chart) {
  const most = 200;
  const details = make("details", { class: "numbers" }, make("summary", {}, "numbers"));
  details.addEventListener("toggle", () => {
    if (!details.open || details.children.length > 1) return;
    const points = chart.lines[0].points;
    const step = Math.ceil(points.length / most);
    const rows = points.map((_, i) => i).filter((i) => i % step === 0 || i === points.length - 1);
    details.append(
      make(
        "div",
        { class: "scroll" },
        make(
          "table",
          {},
          make(
            "thead",
            {},
            make(
              "tr",
              {},
              make("th", { scope: "col", class: "number" }, "call"),
              chart.lines.map(({ label }) => make("th", { scope: "col", class: "number" }, label)),
            ),
          ),
          make(
            "tbody",
            {},
            rows.map((i) =>
              make(
                "tr",
                {},
                make("td", { class: "number" }, countText(points[i][0])),
                chart.lines.map((line) => make("td", { class: "number" }, errorText(line.points[i]?.[1]))),
              ),
            ),
          ),
        ),
        step > 1 && make("p", { class: "note" }, `Every ${step}th of ${countText(points.length)} points.`),
      ),
    );
  });
  return details;
}

/**
 * A figure that draws itself when `draw` is called, with the settings {calls: {low, high}, range, isLog}. A chart is {name, note, type,
 * lines: [{key, label, points: [[call, number], ...]}], marks: [{call, kind, text}]}.
 */
function chartFigure(chart) {
  const holder = make("div", { class: "plot" });
  const figure = make(
    "figure",
    { class: "chart" },
    make(
      "figcaption",
      {},
      make("span", { class: "code" }, nameText(chart.name)),
      chart.note && make("span", { class: "note" }, ` ${chart.note}`),
    ),
    holder,
    numbersOf(chart),
  );
  figure.draw = (settings) => {
    const width = Math.max(240, holder.clientWidth || 480);
    const range = settings.range ?? rangeOf([chart]);
    const scales = scalesOf(width, settings.calls, range, settings.isLog);
    const cursor = makeSvg("g", { class: "cursor" });
    const drawing = makeSvg(
      "svg",
      {
        viewBox: `0 0 ${width} ${chartHeight}`,
        role: "img",
        tabindex: 0,
        "aria-label": summaryOf(chart),
        class: chart.lines.length === 1 && "single",
      },
      axesOf(scales, range, settings.isLog, unitOf(chart.type)),
      marksOf(chart.marks, scales),
      chart.lines.map((line) => lineOf(line, scales)),
      cursor,
    );
    follow(drawing, cursor, chart, scales, width);
    holder.replaceChildren(drawing);
  };
  return figure;
}

/** Shows the numbers of the point that the pointer or the arrow keys choose. */
function follow(drawing, cursor, chart, scales, width) {
  const points = chart.lines[0].points;
  if (!points.length) return;
  let chosen = 0;
  const show = (index) => {
    chosen = Math.max(0, Math.min(points.length - 1, index));
    const call = points[chosen][0];
    const at = scales.x(call);
    cursor.replaceChildren(
      makeSvg("line", { x1: at, x2: at, y1: margin.top, y2: scales.bottom }),
      ...chart.lines.map(({ key, points: all }) =>
        makeSvg("circle", { cx: at, cy: scales.y(all[chosen][1]), r: 3.5, class: `dot ${key}` }),
      ),
    );
    showTip(
      drawing,
      [
        make("b", {}, `call ${countText(call)}`),
        chart.lines.map(({ key, label, points: all }) =>
          make("div", {}, make("i", { class: `key ${key}` }), `${label} ${errorText(all[chosen][1])}`),
        ),
        chart.marks.filter((mark) => mark.call === call).map((mark) => make("div", {}, mark.text)),
      ],
      (at / width) * drawing.clientWidth,
    );
  };
  const hide = () => {
    cursor.replaceChildren();
    tip.remove();
  };
  drawing.addEventListener("pointermove", (event) => {
    const box = drawing.getBoundingClientRect();
    show(nearestPoint(points, scales.x, ((event.clientX - box.left) / box.width) * width));
  });
  drawing.addEventListener("pointerleave", hide);
  drawing.addEventListener("focus", () => drawing.matches(":focus-visible") && show(chosen));
  drawing.addEventListener("blur", hide);
  drawing.addEventListener("keydown", (event) => {
    const moves = { ArrowLeft: chosen - 1, ArrowRight: chosen + 1, Home: 0, End: points.length - 1 };
    if (!(event.key in moves)) return;
    event.preventDefault();
    show(moves[event.key]);
  });
}

/** The numbers of the point that is chosen; one chart has it at a time. */
const tip = make("div", { id: "tip" });

/** Shows numbers beside a place of a chart, within it. */
function showTip(drawing, children, left) {
  const plot = drawing.parentElement;
  tip.replaceChildren(...children.flat(Infinity));
  plot.append(tip);
  const space = plot.clientWidth - tip.offsetWidth;
  tip.style.left = `${left + 14 <= space ? left + 14 : Math.max(0, left - 14 - tip.offsetWidth)}px`;
  tip.style.top = `${margin.top + 4}px`;
}

/** The legend of the charts of outputs. */
function legend() {
  return make(
    "p",
    { class: "legend" },
    lineKinds.map(({ key, label }) => make("span", {}, make("i", { class: `key ${key}` }), label)),
  );
}
