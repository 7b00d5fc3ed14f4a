// SPDX-License-Identifier: MIT
//
// Tables that stay usable with thousands of rows, bars of shares, and the colours of kernels.
"use strict";

/** Colours of the kernels whose errors are the largest part of the results'; all others are grey. */
const colourOf = (() => {
  const colours = new Map();
  const largest = ((isReadable && report.results) || []).flatMap((result) => result.shares ?? []);
  const sums = new Map();
  for (const { kernel, share } of largest) if (Number.isFinite(share)) sums.set(kernel, (sums.get(kernel) ?? 0) + share);
  [...sums]
    .sort((a, b) => b[1] - a[1])
    .slice(0, 8)
    .forEach(([kernel], i) => colours.set(kernel, i + 1));
  return (kernel) => colours.get(kernel) ?? 0;
})();

/** One bar of all shares, largest first, with a legend of those that can be seen. */
function shareBar(shares) {
  const sorted = [...(shares ?? [])]
    .filter(({ share }) => toNumber(share) > 0)
    .sort((a, b) => severity(b.share) - severity(a.share));
  if (!sorted.length) return null;
  const told = sorted.slice(0, 6),
    rest = sorted.slice(6);
  const others = rest.reduce((sum, { share }) => sum + toNumber(share), 0);
  const parts = told.map(({ kernel, share }) => ({ name: kernel, share: toNumber(share), colour: colourOf(kernel) }));
  if (rest.length) parts.push({ name: `${counted(rest.length, "other")}`, share: others, colour: 0 });
  return make(
    "div",
    { class: "shares" },
    make(
      "div",
      { class: "bar", "aria-hidden": "true" },
      parts.map(({ name, share, colour }) =>
        make("span", {
          class: `c${colour}`,
          style: `flex-grow:${Number.isFinite(share) ? share : 1}`,
          title: `${name} ${percentText(share)}`,
        }),
      ),
    ),
    make(
      "ul",
      {},
      parts.map(({ name, share, colour }) =>
        make("li", {}, make("i", { class: `key c${colour}` }), kernelLink(name), " ", make("b", {}, percentText(share))),
      ),
    ),
  );
}

// Decimal digits of float: the scale of the bars of digits, unless something has more.
const finest = 7.2;

/** A small bar for a number from 0 to 1, and the number's text. */
function metered(fraction, kind, text) {
  const part = Math.max(0, Math.min(1, Number.isFinite(fraction) ? fraction : fraction > 0 ? 1 : 0));
  return [
    make("span", { class: `meter ${kind}`, "aria-hidden": "true" }, make("span", { style: `width:${(100 * part).toFixed(1)}%` })),
    make("span", { class: "amount" }, text),
  ];
}

/** The name of a kernel, as a link to its row if it has one. */
function kernelLink(name) {
  const index = kernelIndex.get(name);
  return index === undefined
    ? make("span", { class: "code" }, nameText(name))
    : make("a", { href: `#kernel-${index}`, class: "code" }, nameText(name));
}
const kernelIndex = new Map(((isReadable && report.kernels) || []).map(({ name }, i) => [name, i]));

/**
 * A table. `columns` are {name, title, of, key, isNumber}: `of` gives a cell's content, `key` a number or a text to sort by. `options`:
 * {most: rows shown at first, sort: index of a column, filter: text of a row, noun, row: changes a row's elements, caption}. The result has
 * `reveal(item)`, which shows the row of an item and returns it.
 */
function table(columns, items, options) {
  const state = { sort: options.sort ?? -1, isUp: false, shown: options.most ?? 50, filter: "" };
  const head = make("tr"),
    body = make("tbody"),
    foot = make("p", { class: "more" });
  const rows = new Map(); // by item; a row that was opened stays so
  const rowOf = (item) => {
    if (!rows.has(item)) {
      const cells = columns.map((column, i) =>
        make(i === 0 ? "th" : "td", { class: column.isNumber && "number", scope: i === 0 && "row" }, column.of(item)),
      );
      const row = make("tr", {}, cells);
      rows.set(item, options.row ? options.row(row, item) : [row]);
    }
    return rows.get(item);
  };
  const chosen = () => {
    const some = state.filter ? items.filter((item) => options.filter(item).toLowerCase().includes(state.filter)) : [...items];
    const column = columns[state.sort];
    if (!column) return some;
    const sign = state.isUp ? 1 : -1;
    const compare = (a, b) => (typeof a === "string" ? -a.localeCompare(b) : a === b ? 0 : a < b ? -1 : 1);
    return some.sort((a, b) => sign * compare(column.key(a), column.key(b)));
  };
  const draw = () => {
    const all = chosen();
    body.replaceChildren(...all.slice(0, state.shown).flatMap(rowOf));
    const left = all.length - state.shown, step = Math.max(200, state.shown);
    foot.replaceChildren(
      ...moreButton(left, step, counted(all.length, options.noun ?? "row"), () => {
        state.shown += step;
        draw();
      }),
      ...(all.length || !state.filter ? [] : [`No ${options.noun ?? "row"} contains \u201c${state.filter}\u201d.`]),
    );
    [...head.children].forEach((cell, i) =>
      cell.setAttribute("aria-sort", i !== state.sort ? "none" : state.isUp ? "ascending" : "descending"),
    );
  };
  head.append(
    ...columns.map((column, i) =>
      make(
        "th",
        { scope: "col", class: column.isNumber && "number", title: column.title },
        column.key && items.length > 1
          ? make(
              "button",
              {
                type: "button",
                onclick: () => {
                  state.isUp = state.sort === i && !state.isUp;
                  state.sort = i;
                  draw();
                },
              },
              column.name,
            )
          : column.name,
      ),
    ),
  );
  draw();
  const element = make(
    "div",
    { class: "table" },
    options.filter &&
      items.length > 15 &&
      filterField(options.noun, (text) => {
        state.filter = text;
        draw();
      }),
    make(
      "div",
      { class: "scroll", role: "region", tabindex: 0, "aria-label": options.caption },
      make("table", {}, make("caption", {}, options.caption), make("thead", {}, head), body),
    ),
    foot,
  );
  element.reveal = (item) => {
    if (!rows.has(item) || !rows.get(item)[0].isConnected) {
      state.filter = "";
      const field = element.querySelector("input");
      if (field) field.value = "";
      state.shown = Math.max(state.shown, chosen().indexOf(item) + 1);
      draw();
    }
    return rows.get(item);
  };
  return element;
}

function filterField(noun, onText) {
  return make(
    "label",
    { class: "filter" },
    `Find a ${noun} `,
    make("input", { type: "search", spellcheck: "false", oninput: (event) => onText(event.target.value.trim().toLowerCase()) }),
  );
}

/** A switch between a few choices, as radio buttons. */
function choice(name, label, choices, onChange) {
  return make(
    "fieldset",
    { class: "choice" },
    make("legend", {}, label),
    choices.map((text, i) =>
      make(
        "label",
        {},
        make("input", { type: "radio", name, checked: i === 0, onchange: () => onChange(i) }),
        make("span", {}, text),
      ),
    ),
  );
}

/** The inputs of an element, in decimal and hexadecimal, on the device and in the reference. */
function inputsTable(inputs) {
  if (!inputs?.length) return null;
  return make(
    "div",
    { class: "scroll" },
    make(
      "table",
      { class: "inputs" },
      make(
        "thead",
        {},
        make(
          "tr",
          {},
          ["input", "on the device", "in the reference"].map((name) => make("th", { scope: "col" }, name)),
        ),
      ),
      make(
        "tbody",
        {},
        inputs.map(({ parameter, at = [], value, hex, reference }) =>
          make(
            "tr",
            {},
            make("th", { scope: "row", class: "code" }, elementText(parameter, at)),
            make("td", {}, valueOf({ value, hex })),
            make("td", {}, valueOf(reference)),
          ),
        ),
      ),
    ),
  );
}

/** What an element was computed from, if that is more or less than its inputs say. */
function sourceNote({ source }) {
  return source ? make("p", { class: "note" }, `${source[0].toUpperCase()}${source.slice(1)}.`) : null;
}
