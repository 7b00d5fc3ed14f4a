// SPDX-License-Identifier: MIT
//
// The table by kernel, whose rows open to errors, the worst element and charts.
"use strict";

/** A kernel's largest and typical errors. */
function errorsTable(kernel) {
  const rows = [
    ["own", kernel.own],
    ["of it, storing", kernel.storage],
    ["inherited", kernel.inherited],
    ["total", kernel.total],
  ];
  const amplification = kernel.amplification;
  return make(
    "table",
    { class: "small" },
    make(
      "thead",
      {},
      make(
        "tr",
        {},
        ["error", "largest", "typical"].map((name, i) => make("th", { scope: "col", class: i && "number" }, name)),
      ),
    ),
    make(
      "tbody",
      {},
      rows
        .filter(([, error]) => error)
        .map(([name, error]) =>
          make(
            "tr",
            {},
            make("th", { scope: "row" }, lineKinds.some(({ key }) => key === name) && make("i", { class: `key ${name}` }), name),
            make("td", { class: "number" }, errorText(error.largest)),
            make("td", { class: "number" }, errorText(error.typical)),
          ),
        ),
      amplification &&
        make(
          "tr",
          { class: "apart" },
          make("th", { scope: "row" }, "amplification"),
          make("td", { class: "number" }, errorText(amplification.largest)),
          make("td", { class: "number" }, errorText(amplification.typical)),
        ),
    ),
  );
}

function worstElement({ worst }) {
  if (!worst) return make("p", { class: "note" }, "No element differs from the reference.");
  return [
    make(
      "p",
      {},
      make("span", { class: "code" }, elementText(worst.output, worst.element)),
      ` of call ${countText(worst.call)} is `,
      valueOf(worst.device),
      ", and should be ",
      valueOf(worst.reference),
      ".",
    ),
    inputsTable(worst.inputs),
    sourceNote(worst),
  ];
}

/** What a row shows when it opens. */
function kernelDetails(kernel) {
  const charts = (kernel.outputs ?? []).filter(({ points }) => points?.length).map((output) => chartOfOutput(kernel, output));
  const settings = { calls: callRange(charts), range: null, isLog: false };
  const few = 4;
  const missingCalls = (kernel.calls ?? 0) - (kernel.followed ?? 0);
  return make(
    "div",
    { class: "details" },
    make(
      "div",
      { class: "sides" },
      make(
        "div",
        {},
        make("h4", {}, "Error of its calls"),
        errorsTable(kernel),
        missingCalls > 0 &&
          make(
            "p",
            { class: "note" },
            `${countText(kernel.followed)} of ${counted(kernel.calls, "call")} ran beside the reference.`,
          ),
      ),
      make("div", {}, make("h4", {}, "Its worst element"), worstElement(kernel)),
    ),
    charts.length > 0 && [make("h4", {}, "Error over its calls"), legend(), chartGrid(charts.slice(0, few), settings)],
    charts.length > few &&
      make("p", { class: "note" }, `${counted(charts.length - few, "other output")} in \u201cError over calls\u201d.`),
  );
}

/** The table by kernel. */
function kernelsSection() {
  const kernels = report.kernels ?? [];
  if (!kernels.length)
    return section(
      "kernels",
      "Kernels",
      null,
      make("p", {}, report.calls > 0 ? "No call was followed." : "The program called no kernel."),
    );
  const digitsScale = Math.max(finest, ...kernels.map(({ digits }) => toNumber(digits)).filter(Number.isFinite));
  const number = (name, title, key, of) => ({ name, title, isNumber: true, key, of });
  const exceptional = (kernel) => (kernel.nans ?? 0) + (kernel.infinities ?? 0) + (kernel.flushed ?? 0);
  const sorted = (of) => (kernel) => severity(of(kernel));
  const errors = (name, title, of) => ({ name, title, isNumber: true, key: sorted(of), of: (kernel) => errorText(of(kernel)) });
  const columns = [
    {
      name: "kernel",
      key: ({ name }) => name,
      of: (kernel) => make("button", { type: "button", class: "opens code", "aria-expanded": "false" }, nameText(kernel.name)),
    },
    {
      name: "share",
      title: "How much of the error of all results its own errors cause",
      isNumber: true,
      key: sorted(({ share }) => share),
      of: ({ share, compensates }) =>
        metered(toNumber(share), "share", compensates && !(toNumber(share) > 0) ? `<0${narrowSpace}%` : percentText(share)),
    },
    {
      name: "digits",
      title: "Decimal digits that survive",
      isNumber: true,
      key: ({ digits }) => digitsKey(digits),
      of: ({ digits }) => metered(toNumber(digits) / digitsScale, "digits", digitsText(digits)),
    },
    errors("own", "The largest error that a call adds, from the device\u2019s own inputs", ({ own }) => own?.largest),
    errors("inherited", "The largest error that its inputs bring", ({ inherited }) => inherited?.largest),
    errors(
      "amplification",
      "Inherited error over the error of the inputs, at most",
      ({ amplification }) => amplification?.largest,
    ),
    number(
      "calls",
      "How often it ran",
      ({ calls }) => calls ?? 0,
      ({ calls }) => countText(calls),
    ),
    number(
      "time",
      "Time of all of its calls on the device",
      ({ seconds }) => seconds ?? 0,
      ({ seconds }) => timeText(seconds),
    ),
    number("exceptions", "NaN, infinities and values flushed to zero that the reference does not have", exceptional, (kernel) =>
      make("span", { class: (kernel.nans || kernel.infinities) && "bad" }, exceptionsText(kernel)),
    ),
    number(
      "decisions",
      "Elements that decide differently from the reference",
      ({ decisions }) => decisions ?? 0,
      ({ decisions }) => make("span", { class: decisions && "warn" }, countText(decisions ?? 0)),
    ),
  ];
  const open = (row, more, button, isOpen) => {
    if (isOpen && !more.firstChild.firstChild) more.firstChild.append(kernelDetails(more.kernel));
    more.hidden = !isOpen;
    button.setAttribute("aria-expanded", String(isOpen));
    row.classList.toggle("open", isOpen);
  };
  const list = table(columns, kernels, {
    most: 25,
    sort: 1,
    noun: "kernel",
    caption: "Kernels",
    filter: ({ name }) => name,
    row(row, kernel) {
      const more = make("tr", { hidden: true, class: "more" }, make("td", { colspan: columns.length }));
      more.kernel = kernel;
      const button = row.querySelector("button");
      row.id = `kernel-${kernelIndex.get(kernel.name)}`;
      row.classList.add("can-open");
      row.addEventListener("click", (event) =>
        event.target.closest("a") || getSelection().toString() ? null : open(row, more, button, more.hidden),
      );
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
  return section(
    "kernels",
    "Kernels",
    "A call\u2019s own error is what it adds to the inputs that it gets; the error of these inputs is inherited. A row opens to the kernel\u2019s worst element and its charts.",
    list,
  );
}
