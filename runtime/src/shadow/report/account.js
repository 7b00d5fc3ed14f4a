// SPDX-License-Identifier: MIT
//
// The account of what no result required, and how the program was run.
"use strict";

/** What the results did not need. */
function accountSection() {
  const { unread = [], partly = [], precision = [] } = report.account ?? {};
  const time = { name: "time", isNumber: true, key: ({ seconds }) => severity(seconds), of: ({ seconds }) => timeText(seconds) };
  const kernel = { name: "kernel", key: ({ kernel: name }) => name, of: ({ kernel: name }) => kernelLink(name) };
  const sum = (rows) => rows.reduce((all, { seconds }) => all + (Number.isFinite(seconds) ? seconds : 0), 0);
  const part = (title, rows, columns, noun) =>
    rows.length > 0 &&
    make(
      "div",
      { class: "part" },
      make("h3", {}, title, make("span", { class: "note" }, ` ${timeText(sum(rows))}`)),
      table(columns, rows, {
        most: 10,
        sort: columns.indexOf(time),
        noun,
        caption: title,
        filter: (row) => `${row.kernel ?? ""} ${row.output ?? ""} ${row.stream ?? ""}`,
      }),
    );
  const parts = [
    part(
      "Outputs that nothing read",
      unread,
      [
        kernel,
        { name: "output", key: ({ output }) => output, of: ({ output }) => make("span", { class: "code" }, output) },
        { name: "calls", isNumber: true, key: ({ calls }) => calls, of: ({ calls }) => countText(calls) },
        time,
      ],
      "output",
    ),
    part(
      "Streams of which only a part was read",
      partly,
      [
        { name: "stream", key: ({ stream }) => stream, of: ({ stream }) => make("span", { class: "code" }, nameText(stream)) },
        { name: "read", isNumber: true, key: ({ read }) => read, of: ({ read }) => metered(read, "share", percentText(read)) },
        time,
      ],
      "stream",
    ),
    part(
      "Precision that no result needed",
      precision,
      [
        kernel,
        {
          name: "share",
          title: "How much of the error of all results it causes",
          isNumber: true,
          key: ({ share }) => severity(share),
          of: ({ share }) => percentText(share),
        },
        time,
        { name: "advice", of: ({ text }) => make("span", { class: "prose" }, text ?? "") },
      ],
      "kernel",
    ),
  ].filter(Boolean);
  if (!parts.length) return null;
  return section(
    "account",
    "What the results did not require",
    "Work whose outcome no result needed, with the time of the calls that did it.",
    parts,
  );
}

/** The program's time, by what it was spent on. */
function timeBar() {
  const { program, device, reference, comparison } = report.seconds ?? {};
  if (!(program > 0)) return null;
  const rest = Math.max(0, program - device - reference - comparison);
  const parts = [
    ["the device\u2019s calls", device, "device"],
    ["the reference\u2019s calls", reference, "reference"],
    ["comparing", comparison, "comparison"],
    ["the rest of the program", rest, "rest"],
  ].filter(([, seconds]) => seconds > 0);
  const alone = program - reference - comparison;
  return [
    make(
      "div",
      { class: "shares" },
      make(
        "div",
        { class: "bar", "aria-hidden": "true" },
        parts.map(([, seconds, kind]) => make("span", { class: kind, style: `flex-grow:${seconds / program}` })),
      ),
      make(
        "ul",
        {},
        parts.map(([name, seconds, kind]) =>
          make("li", {}, make("i", { class: `key ${kind}` }), name, " ", make("b", {}, timeText(seconds))),
        ),
      ),
    ),
    make(
      "p",
      {},
      `The program ran for ${timeText(program)}${alone > 0 && alone < program ? `, ${errorText(program / alone)} times as long as without the shadow` : ""}.`,
    ),
  ];
}

/** Options, time, ranks and notes. */
function runSection() {
  const { every = 1, kernels = ["*"], decisions } = report.options ?? {};
  const isAll = kernels.length === 1 && kernels[0] === "*";
  const rows = [
    ["Device", report.device],
    ["Reference", `${report.reference}, on the cores`],
    [
      "Followed",
      `${every > 1 ? `one of ${every} calls` : "every call"} of ${isAll ? "all kernels" : kernels.join(", ")}: ${callsText()}`,
    ],
    ["Decisions", decisions === "follow" ? "the reference takes the device\u2019s" : "the reference makes its own"],
    ["Ended", report.ended],
  ];
  const notes = report.notes ?? [];
  const few = 12;
  const ranks = report.perRank ?? [];
  return section(
    "run",
    "How it was run",
    null,
    make(
      "dl",
      {},
      rows.filter(([, text]) => text).map(([name, text]) => [make("dt", {}, name), make("dd", {}, text)]),
    ),
    timeBar(),
    ranks.length > 0 &&
      table(
        [
          { name: "rank", key: ({ rank }) => rank, of: ({ rank }) => countText(rank) },
          { name: "device", key: ({ device }) => device ?? "", of: ({ device }) => device },
          { name: "calls", isNumber: true, key: ({ calls }) => calls ?? 0, of: ({ calls }) => countText(calls) },
        ],
        ranks,
        { most: 16, noun: "rank", caption: "Ranks" },
      ),
    notes.length > 0 && [
      make("h3", {}, "Notes"),
      make(
        "ul",
        { class: "prose" },
        notes.slice(0, few).map((note) => make("li", {}, note)),
      ),
    ],
    notes.length > few &&
      make(
        "details",
        {},
        make("summary", {}, `${countText(notes.length - few)} more`),
        make(
          "ul",
          { class: "prose" },
          notes.slice(few).map((note) => make("li", {}, note)),
        ),
      ),
  );
}
