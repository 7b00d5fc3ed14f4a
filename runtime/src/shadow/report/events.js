// SPDX-License-Identifier: MIT
//
// The lives of exceptional values, and the decisions that differ.
"use strict";

/** Where an exceptional value went, as a chain of calls. */
function pathList(path) {
  if (!path?.length) return make("p", { class: "note" }, "It went no further.");
  const few = 12;
  const step = ({ call, kernel, output, elements }) =>
    make(
      "li",
      {},
      kernelLink(kernel),
      make("span", { class: "code" }, ` ${output}`),
      make("span", { class: "note" }, ` call ${countText(call)}, ${counted(elements, "element")}`),
    );
  const told = path.length <= few + 1 ? path : path.slice(0, few);
  return make(
    "ol",
    { class: "path" },
    told.map(step),
    told !== path && [make("li", { class: "gap" }, `${countText(path.length - few - 1)} more calls`), step(path.at(-1))],
  );
}

function life(event) {
  const names = { nan: "NaN", infinity: "infinity", flush: "flush to zero" };
  return make(
    "article",
    { class: "life" },
    make(
      "h3",
      {},
      make("span", { class: `badge ${event.kind}` }, nameOfKind(event.kind)),
      ` Call ${countText(event.call)}: `,
      kernelLink(event.kernel),
      make("span", { class: "code" }, ` ${elementText(event.output, event.element)}`),
    ),
    make(
      "p",
      {},
      "The device has ",
      valueOf(event.device),
      ", the reference ",
      valueOf(event.reference),
      event.elements > 1 && `. The same happened to ${counted(event.elements - 1, "other element")} of this call`,
      ".",
    ),
    make(
      "div",
      { class: "sides" },
      make(
        "div",
        {},
        make("h4", {}, "Born from"),
        inputsTable(event.inputs) ??
          (!event.source && make("p", { class: "note" }, `The first ${names[event.kind] ?? event.kind} of this element has no inputs.`)),
        sourceNote(event),
      ),
      make("div", {}, make("h4", {}, "Where it went"), pathList(event.path)),
    ),
  );
}

/** Where exceptional values were born, and where they went. */
function livesSection() {
  const all = report.exceptions ?? [];
  if (!all.length) return null;
  const few = 6;
  const more = all.slice(few);
  const rest = make("details", { class: "rest" }, make("summary", {}, `${countText(more.length)} more`));
  rest.addEventListener("toggle", () => rest.children.length === 1 && rest.append(...more.map(life)));
  return section(
    "lives",
    "The lives of exceptional values",
    "NaN, infinities and values flushed to zero that the reference does not have: the element that was first, what it was computed from, and the calls that it reached.",
    all.slice(0, few).map(life),
    more.length > 0 && rest,
  );
}

/** Decisions, of which the first that is no consequence of another is marked. */
function decisionsSection() {
  const all = report.decisions ?? [];
  if (!all.length) return null;
  const first = all.filter(({ isInherited }) => !isInherited).reduce((a, b) => (a && a.call <= b.call ? a : b), null);
  const columns = [
    { name: "call", isNumber: true, key: ({ call }) => call, of: (one) => countText(one.call) },
    { name: "kernel", key: ({ kernel }) => kernel, of: ({ kernel }) => kernelLink(kernel) },
    { name: "first element", of: ({ output, element }) => make("span", { class: "code" }, elementText(output, element)) },
    { name: "elements", isNumber: true, key: ({ elements }) => elements ?? 0, of: ({ elements }) => countText(elements) },
    { name: "device", isNumber: true, of: ({ device }) => valueOf(device) },
    { name: "reference", isNumber: true, of: ({ reference }) => valueOf(reference) },
    {
      name: "cause",
      key: ({ isInherited }) => (isInherited ? "b" : "a"),
      of: (one) =>
        one.isInherited
          ? make("span", { class: "note short" }, "its inputs differed")
          : make("span", { class: "warn short" }, one === first ? "its own, the first" : "its own"),
    },
  ];
  const isFollowing = report.options?.decisions === "follow";
  return section(
    "decisions",
    "Decisions that differ",
    isFollowing
      ? "Integers, orders and counts that differ from the reference. The reference took over the device\u2019s decisions, so errors after them are comparable."
      : "Integers, orders and counts that differ from the reference. Errors after the first of them compare two different courses; decisions=follow lets the reference take the device\u2019s.",
    table(columns, all, {
      most: 20,
      noun: "decision",
      caption: "Decisions that differ",
      filter: ({ kernel, output }) => `${kernel} ${output}`,
      row(row, one) {
        if (one === first) row.classList.add("first");
        return [row];
      },
    }),
  );
}
