// SPDX-License-Identifier: MIT
//
// The parts of the page that are mostly text: verdicts, results, the lives of exceptional values, decisions, the account, and how the
// program was run. Each returns a section, or null if the report has nothing for it.
"use strict";

function section(id, title, lead, ...content) {
  const element = make("section", { id, "aria-labelledby": `${id}-title` }, make("h2", { id: `${id}-title` }, title), lead && make("p", { class: "lead" }, lead), content);
  return element;
}

/** A sentence of the report, with the kernel's name as a link. */
function sentence(text, kernel) {
  const at = kernel ? text.indexOf(kernel) : -1;
  return at < 0 ? text : [text.slice(0, at), kernelLink(kernel), text.slice(at + kernel.length)];
}

/** Part (a). The first verdict is the page's headline. */
function verdicts() {
  const all = report.verdicts ?? [];
  const badge = ({ kind }) => make("span", { class: `badge ${kind}` }, nameOfKind(kind));
  const where = ({ call, kernel }) => (kernel && typeof call === "number" ? make("span", { class: "note" }, ` call ${countText(call)}`) : null);
  if (!all.length) return make("p", { class: "verdict" }, "The report has no verdict.");
  const [first, ...others] = all;
  const few = 8;
  const list = (some) => some.map((verdict) => make("li", {}, badge(verdict), make("span", {}, sentence(verdict.text, verdict.kernel))));
  return [
    make("div", { class: `verdict ${first.kind}`, id: "verdict" }, make("p", { class: "kind" }, badge(first), where(first)), make("p", { class: "text" }, sentence(first.text, first.kernel))),
    others.length > 0 && make("ul", { class: "verdicts" }, list(others.slice(0, few))),
    others.length > few && make("details", {}, make("summary", {}, `${countText(others.length - few)} more`), make("ul", { class: "verdicts" }, list(others.slice(few))))];
}

function callsText() {
  const { calls, followed } = report;
  if (!calls) return "no calls";
  return followed === calls ? `${counted(calls, "call")}, all followed` : `${counted(calls, "call")}, ${countText(followed)} followed`;
}

function pageHead() {
  const ended = report.ended ?? "normally";
  return [
    make("p", { class: "kicker" }, "Shadow report"),
    make("h1", {}, report.program || "A program"),
    make("p", { class: "meta" }, [`on ${report.device}`, `beside ${report.reference} precision`, callsText(), report.ranks > 1 && counted(report.ranks, "rank")].filter(Boolean).join(" \u00b7 ")),
    ended !== "normally" && make("p", { class: "warning", role: "note" }, `The shadow ended ${ended}. What follows is true up to there.`),
    verdicts()];
}

/** Part (b): what the host read, and whose errors it has. */
function resultsSection() {
  const results = report.results ?? [];
  if (!results.length) return section("results", "What the program read", null, make("p", {}, "The program read no result back, so there is nothing that an error could reach."));
  const digitsScale = Math.max(finest, ...results.map(({ digits }) => toNumber(digits)).filter(Number.isFinite));
  const columns = [
    { name: "result", key: ({ name }) => name, of: ({ name, kind }) => [make("span", { class: "code" }, nameText(name)), kind === "value" && make("span", { class: "note" }, " value")] },
    { name: "digits", title: "Decimal digits that survive", isNumber: true, key: ({ digits }) => digitsKey(digits),
      of: ({ digits }) => metered(toNumber(digits) / digitsScale, "digits", make("b", {}, digitsText(digits))) },
    { name: "largest error", isNumber: true, key: ({ error }) => severity(error?.largest), of: ({ error }) => errorText(error?.largest) },
    { name: "last error", title: "The error of the last read", isNumber: true, key: ({ error }) => severity(error?.last), of: ({ error }) => errorText(error?.last) },
    { name: "reads", isNumber: true, key: ({ reads }) => reads ?? 0, of: ({ reads }) => countText(reads) },
    { name: "elements", isNumber: true, key: ({ elements }) => elements ?? 0, of: ({ elements }) => countText(elements) },
  ];
  if (results.some(({ differs }) => differs)) {
    columns.push({ name: "differ", title: "Elements of integers that differ", isNumber: true, key: ({ differs }) => differs ?? 0, of: ({ differs }) => make("span", { class: differs && "warn" }, countText(differs ?? 0)) });
  }
  return section("results", "What the program read",
    "Every stream and value that reached the host, and how much of its error each kernel caused.",
    table(columns, results, {
      most: 12, sort: 2, noun: "result", caption: "Results", filter: ({ name }) => name,
      row(row, result) {
        const bar = shareBar(result.shares);
        if (!bar) return [row];
        row.classList.add("with-bar");
        return [row, make("tr", { class: "more" }, make("td", { colspan: columns.length }, make("div", { class: "details" }, bar)))];
      },
    }));
}

/** Where an exceptional value went, as a chain of calls. */
function pathList(path) {
  if (!path?.length) return make("p", { class: "note" }, "It went no further.");
  const few = 12;
  const step = ({ call, kernel, output, elements }) =>
    make("li", {}, kernelLink(kernel), make("span", { class: "code" }, ` ${output}`), make("span", { class: "note" }, ` call ${countText(call)}, ${counted(elements, "element")}`));
  const told = path.length <= few + 1 ? path : path.slice(0, few);
  return make("ol", { class: "path" }, told.map(step), told !== path && [make("li", { class: "gap" }, `${countText(path.length - few - 1)} more calls`), step(path.at(-1))]);
}

function life(event) {
  const names = { nan: "NaN", infinity: "infinity", flush: "flush to zero" };
  return make("article", { class: "life" },
    make("h3", {}, make("span", { class: `badge ${event.kind}` }, nameOfKind(event.kind)), ` Call ${countText(event.call)}: `, kernelLink(event.kernel),
      make("span", { class: "code" }, ` ${elementText(event.output, event.element)}`)),
    make("p", {}, "The device has ", valueOf(event.device), ", the reference ", valueOf(event.reference), event.elements > 1 && `. The same happened to ${counted(event.elements - 1, "other element")} of this call`, "."),
    make("div", { class: "sides" },
      make("div", {}, make("h4", {}, "Born from"), inputsTable(event.inputs) ?? make("p", { class: "note" }, `The first ${names[event.kind] ?? event.kind} of this element has no inputs.`)),
      make("div", {}, make("h4", {}, "Where it went"), pathList(event.path))));
}

/** Part (e). */
function livesSection() {
  const all = report.exceptions ?? [];
  if (!all.length) return null;
  const few = 6;
  const more = all.slice(few);
  const rest = make("details", { class: "rest" }, make("summary", {}, `${countText(more.length)} more`));
  rest.addEventListener("toggle", () => rest.children.length === 1 && rest.append(...more.map(life)));
  return section("lives", "The lives of exceptional values", "NaN, infinities and values flushed to zero that the reference does not have: the element that was first, what it was computed from, and the calls that it reached.",
    all.slice(0, few).map(life), more.length > 0 && rest);
}

/** Part (f). */
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
    { name: "cause", key: ({ isInherited }) => (isInherited ? "b" : "a"), of: (one) => (one.isInherited ? make("span", { class: "note short" }, "its inputs differed") : make("span", { class: "warn short" }, one === first ? "its own, the first" : "its own")) },
  ];
  const isFollowing = report.options?.decisions === "follow";
  return section("decisions", "Decisions that differ",
    isFollowing ? "Integers, orders and counts that differ from the reference. The reference took over the device\u2019s decisions, so errors after them are comparable."
      : "Integers, orders and counts that differ from the reference. Errors after the first of them compare two different courses; decisions=follow lets the reference take the device\u2019s.",
    table(columns, all, { most: 20, noun: "decision", caption: "Decisions that differ", filter: ({ kernel, output }) => `${kernel} ${output}`,
      row(row, one) {
        if (one === first) row.classList.add("first");
        return [row];
      } }));
}

/** Part (g): what the results did not need. */
function accountSection() {
  const { unread = [], partly = [], precision = [] } = report.account ?? {};
  const time = { name: "time", isNumber: true, key: ({ seconds }) => severity(seconds), of: ({ seconds }) => timeText(seconds) };
  const kernel = { name: "kernel", key: ({ kernel: name }) => name, of: ({ kernel: name }) => kernelLink(name) };
  const sum = (rows) => rows.reduce((all, { seconds }) => all + (Number.isFinite(seconds) ? seconds : 0), 0);
  const part = (title, rows, columns, noun) => rows.length > 0 && make("div", { class: "part" }, make("h3", {}, title, make("span", { class: "note" }, ` ${timeText(sum(rows))}`)),
    table(columns, rows, { most: 10, sort: columns.indexOf(time), noun, caption: title, filter: (row) => `${row.kernel ?? ""} ${row.output ?? ""} ${row.stream ?? ""}` }));
  const parts = [
    part("Outputs that nothing read", unread, [kernel, { name: "output", key: ({ output }) => output, of: ({ output }) => make("span", { class: "code" }, output) },
      { name: "calls", isNumber: true, key: ({ calls }) => calls, of: ({ calls }) => countText(calls) }, time], "output"),
    part("Streams of which only a part was read", partly, [{ name: "stream", key: ({ stream }) => stream, of: ({ stream }) => make("span", { class: "code" }, nameText(stream)) },
      { name: "read", isNumber: true, key: ({ read }) => read, of: ({ read }) => metered(read, "share", percentText(read)) }, time], "stream"),
    part("Precision that no result needed", precision, [kernel, { name: "share", title: "How much of the error of all results it causes", isNumber: true, key: ({ share }) => severity(share), of: ({ share }) => percentText(share) },
      time, { name: "advice", of: ({ text }) => make("span", { class: "prose" }, text ?? "") }], "kernel"),
  ].filter(Boolean);
  if (!parts.length) return null;
  return section("account", "What the results did not require", "Work whose outcome no result needed, with the time of the calls that did it.", parts);
}

/** The program's time, by what it was spent on. */
function timeBar() {
  const { program, device, reference, comparison } = report.seconds ?? {};
  if (!(program > 0)) return null;
  const rest = Math.max(0, program - device - reference - comparison);
  const parts = [["the device\u2019s calls", device, "device"], ["the reference\u2019s calls", reference, "reference"], ["comparing", comparison, "comparison"], ["the rest of the program", rest, "rest"]].filter(([, seconds]) => seconds > 0);
  const alone = program - reference - comparison;
  return [
    make("div", { class: "shares" }, make("div", { class: "bar", "aria-hidden": "true" }, parts.map(([, seconds, kind]) => make("span", { class: kind, style: `flex-grow:${seconds / program}` }))),
      make("ul", {}, parts.map(([name, seconds, kind]) => make("li", {}, make("i", { class: `key ${kind}` }), name, " ", make("b", {}, timeText(seconds)))))),
    make("p", {}, `The program ran for ${timeText(program)}${alone > 0 && alone < program ? `, ${errorText(program / alone)} times as long as without the shadow` : ""}.`)];
}

/** Part (h). */
function runSection() {
  const { every = 1, kernels = ["*"], decisions } = report.options ?? {};
  const isAll = kernels.length === 1 && kernels[0] === "*";
  const rows = [
    ["Device", report.device], ["Reference", `${report.reference} precision on the cores`],
    ["Followed", `${every > 1 ? `one of ${every} calls` : "every call"} of ${isAll ? "all kernels" : kernels.join(", ")}: ${callsText()}`],
    ["Decisions", decisions === "follow" ? "the reference takes the device\u2019s" : "the reference makes its own"],
    ["Ended", report.ended],
  ];
  const notes = report.notes ?? [];
  const few = 12;
  const ranks = report.perRank ?? [];
  return section("run", "How it was run", null,
    make("dl", {}, rows.filter(([, text]) => text).map(([name, text]) => [make("dt", {}, name), make("dd", {}, text)])), timeBar(),
    ranks.length > 0 && table([
      { name: "rank", key: ({ rank }) => rank, of: ({ rank }) => countText(rank) }, { name: "device", key: ({ device }) => device ?? "", of: ({ device }) => device },
      { name: "calls", isNumber: true, key: ({ calls }) => calls ?? 0, of: ({ calls }) => countText(calls) }], ranks, { most: 16, noun: "rank", caption: "Ranks" }),
    make("h3", {}, "Notes"),
    notes.length ? make("ul", { class: "prose" }, notes.slice(0, few).map((note) => make("li", {}, note))) : make("p", { class: "note" }, "Nothing was left out."),
    notes.length > few && make("details", {}, make("summary", {}, `${countText(notes.length - few)} more`), make("ul", { class: "prose" }, notes.slice(few).map((note) => make("li", {}, note)))));
}
