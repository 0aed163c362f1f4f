// A table of results, whose rows may have actions.

import { el, shown, signed } from "./dom.js";

/** @param columns of {words, unit, digits, base}: `base` shows a difference to the first row. */
export function dataTable(caption, columns, rows, actions = null) {
  const first = rows[0] || [];
  const cell = (value, k) => {
    const { digits = 2, base } = columns[k];
    if (k === 0) return el("th", { scope: "row" }, String(value));
    if (typeof value === "boolean") return el("td", {}, value ? "yes" : "no");
    if (typeof value !== "number") return el("td", {}, value === null || value === undefined ? "–" : String(value));
    const difference = base && typeof first[k] === "number" && value !== first[k] ? signed(value - first[k], digits) : "";
    return el("td", { class: "number" }, shown(value, digits), difference && el("span", { class: "change" }, ` ${difference}`));
  };
  return el("table", {}, el("caption", { class: "hidden" }, caption),
    el("thead", {}, el("tr", {}, columns.map(({ words, unit }) => el("th", { scope: "col" }, unit ? `${words} [${unit}]` : words)), actions && el("td", {}))),
    el("tbody", {}, rows.map((row, r) => el("tr", {}, row.map(cell), actions && el("td", { class: "row-actions" }, actions(r))))));
}
