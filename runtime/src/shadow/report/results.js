// SPDX-License-Identifier: MIT
//
// The head of the page, with the verdicts, and the results that the program read.
"use strict";

function section(id, title, lead, ...content) {
  return make(
    "section",
    { id, "aria-labelledby": `${id}-title` },
    make("h2", { id: `${id}-title` }, title),
    lead && make("p", { class: "lead" }, lead),
    content,
  );
}

/** A sentence of the report, with the kernel's name as a link. */
function sentence(text, kernel) {
  const name = (kernel ?? "").replace(/[^\w:]/g, "\\$&");
  const at = name ? text.search(new RegExp(`(?<![\\w:])${name}(?!\\w|::)`)) : -1; // not within another word
  return at < 0 ? text : [text.slice(0, at), kernelLink(kernel), text.slice(at + kernel.length)];
}

/** The first verdict is the page's headline. */
function verdicts() {
  const all = report.verdicts ?? [];
  const badge = ({ kind }) => make("span", { class: `badge ${kind}` }, nameOfKind(kind));
  const where = ({ kind, call }) =>
    kind !== "fine" && kind !== "nothing" && typeof call === "number"
      ? make("span", { class: "note" }, ` call ${countText(call)}`)
      : null;
  if (!all.length) return make("p", { class: "verdict" }, "The report has no verdict.");
  const [first, ...others] = all;
  const few = 8;
  const list = (some) =>
    some.map((verdict) => make("li", {}, badge(verdict), make("span", {}, sentence(verdict.text, verdict.kernel))));
  return [
    make(
      "div",
      { class: `verdict ${first.kind}`, id: "verdict" },
      make("p", { class: "kind" }, badge(first), where(first)),
      make("p", { class: "text" }, sentence(first.text, first.kernel)),
    ),
    others.length > 0 && make("ul", { class: "verdicts" }, list(others.slice(0, few))),
    others.length > few &&
      make(
        "details",
        {},
        make("summary", {}, `${countText(others.length - few)} more`),
        make("ul", { class: "verdicts" }, list(others.slice(few))),
      ),
  ];
}

function callsText() {
  const { calls, followed } = report;
  if (!calls) return "no calls";
  return followed === calls
    ? `${counted(calls, "call")}, all followed`
    : `${counted(calls, "call")}, ${countText(followed)} followed`;
}

function pageHead() {
  const ended = report.ended ?? "normally";
  return [
    make("p", { class: "kicker" }, "Shadow report"),
    make("h1", {}, report.program || "A program"),
    make(
      "p",
      { class: "meta" },
      [
        `on ${report.device}`,
        `beside a reference in ${report.reference}`,
        callsText(),
        report.ranks > 1 && counted(report.ranks, "rank"),
      ]
        .filter(Boolean)
        .join(" \u00b7 "),
    ),
    ended !== "normally" &&
      make("p", { class: "warning", role: "note" }, `The shadow ended ${ended}. What follows is true up to there.`),
    verdicts(),
  ];
}

/** What the host read, and whose errors it has. */
function resultsSection() {
  const results = report.results ?? [];
  if (!results.length)
    return section(
      "results",
      "What the program read",
      null,
      make(
        "p",
        {},
        report.calls > 0 && !report.followed
          ? "No call was followed, so that the errors of results are not known."
          : (report.ended ?? "normally") === "normally"
            ? "The program read no result back, so there is nothing that an error could reach."
            : "The program had read no result back when this report was written; it may have read some later.",
      ),
    );
  const digitsScale = Math.max(finest, ...results.map(({ digits }) => toNumber(digits)).filter(Number.isFinite));
  const columns = [
    {
      name: "result",
      key: ({ name }) => name,
      of: ({ name, kind }) => [
        make("span", { class: "code" }, nameText(name)),
        kind === "value" && make("span", { class: "note" }, " value"),
      ],
    },
    {
      name: "digits",
      title: "Decimal digits that survive",
      isNumber: true,
      key: ({ digits }) => digitsKey(digits),
      of: ({ digits }) => metered(toNumber(digits) / digitsScale, "digits", make("b", {}, digitsText(digits))),
    },
    {
      name: "largest error",
      isNumber: true,
      key: ({ error }) => severity(error?.largest),
      of: ({ error }) => errorText(error?.largest),
    },
    {
      name: "last error",
      title: "The error of the last read",
      isNumber: true,
      key: ({ error }) => severity(error?.last),
      of: ({ error }) => errorText(error?.last),
    },
    { name: "reads", isNumber: true, key: ({ reads }) => reads ?? 0, of: ({ reads }) => countText(reads) },
    { name: "elements", isNumber: true, key: ({ elements }) => elements ?? 0, of: ({ elements }) => countText(elements) },
  ];
  if (results.some(({ differs }) => differs)) {
    columns.push({
      name: "differ",
      title: "Elements of integers that differ",
      isNumber: true,
      key: ({ differs }) => differs ?? 0,
      of: ({ differs }) => make("span", { class: differs && "warn" }, countText(differs ?? 0)),
    });
  }
  return section(
    "results",
    "What the program read",
    "Every stream and value that reached the host, and how much of its error each kernel caused.",
    table(columns, results, {
      most: 12,
      sort: 2,
      noun: "result",
      caption: "Results",
      filter: ({ name }) => name,
      row(row, result) {
        const bar = shareBar(result.shares);
        if (!bar) return [row];
        row.classList.add("with-bar");
        return [
          row,
          make("tr", { class: "more" }, make("td", { colspan: columns.length }, make("div", { class: "details" }, bar))),
        ];
      },
    }),
  );
}
