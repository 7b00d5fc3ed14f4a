// SPDX-License-Identifier: MIT
//
// Puts the page together, from the most important part to the least.
"use strict";

/** The parts in order, with their short titles. */
const parts = {
  results: { title: "Results", show: resultsSection },
  kernels: { title: "Kernels", show: kernelsSection },
  pictures: { title: "Error over calls", show: picturesSection },
  lives: { title: "Exceptional values", show: livesSection },
  decisions: { title: "Decisions", show: decisionsSection },
  account: { title: "Account", show: accountSection },
  run: { title: "How it was run", show: runSection },
};

/** A part of the page. One that is damaged says so, and leaves the others as they are. */
function partOf(id) {
  const { title, show } = parts[id];
  try {
    return show();
  } catch (error) {
    console.error(error);
    return section(id, title, null, make("p", { class: "warning" }, `This part of the report is damaged: ${error.message}`));
  }
}

function showPage() {
  const main = document.getElementById("main");
  const top = document.getElementById("top");
  if (report === null) {
    main.append(make("p", {}, "This is the empty page of a report. \u201csk shadow FILE.json --html FILE.html\u201d fills it."));
    return;
  }
  if (!isReadable) {
    main.append(
      make("p", { class: "warning" }, "This page shows version 1 of the format streamkernel-shadow, and its report is another."),
    );
    return;
  }
  document.title = `Shadow report: ${report.program || "a program"}`;
  top.append(...pageHead().flat(Infinity).filter(Boolean));
  const sections = Object.keys(parts).map(partOf).filter(Boolean);
  top.append(
    make(
      "nav",
      { "aria-label": "Parts of the report" },
      sections.map(({ id }) => make("a", { href: `#${id}` }, parts[id].title)),
    ),
  );
  main.append(...sections);
  const none = [
    [report.exceptions, "no NaN, infinity or flush to zero that the reference does not have"],
    [report.decisions, "no decision that differs"],
  ]
    .filter(([list]) => !list?.length)
    .map(([, text]) => text);
  document
    .getElementById("foot")
    .append(
      make(
        "p",
        {},
        none.length > 0 && report.followed > 0 && `There was ${none.join(", and ")}. `,
        "Errors are relative to the root mean square of the reference\u2019s elements. The same numbers are in the JSON file beside this page, which \u201csk shadow\u201d prints in a terminal.",
      ),
    );
}

showPage();
