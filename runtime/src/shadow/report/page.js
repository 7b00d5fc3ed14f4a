// SPDX-License-Identifier: MIT
//
// Puts the page together, from the most important part to the least.
"use strict";

const shortTitles = {
  results: "Results",
  kernels: "Kernels",
  pictures: "Error over calls",
  lives: "Exceptional values",
  decisions: "Decisions",
  account: "Account",
  run: "How it was run",
};

function showPage() {
  const main = document.getElementById("main"),
    top = document.getElementById("top");
  if (report === null) {
    main.append(make("p", {}, "This is the empty page of a report. \u201csk shadow FILE.json --html FILE.html\u201d fills it."));
    return;
  }
  if (report.format !== "streamkernel-shadow" || report.version !== 1) {
    main.append(
      make("p", { class: "warning" }, "This page shows version 1 of the format streamkernel-shadow, and its report is another."),
    );
    return;
  }
  document.title = `Shadow report: ${report.program || "a program"}`;
  top.append(...pageHead().flat(Infinity).filter(Boolean));
  const sections = [
    resultsSection(),
    kernelsSection(),
    picturesSection(),
    livesSection(),
    decisionsSection(),
    accountSection(),
    runSection(),
  ].filter(Boolean);
  top.append(
    make(
      "nav",
      { "aria-label": "Parts of the report" },
      sections.map(({ id }) => make("a", { href: `#${id}` }, shortTitles[id])),
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
