// A list of rows of the scenario as a table of cells, into which a range of a spreadsheet may be pasted.

import { el, written } from "./dom.js";
import { at } from "./documents.js";
import { numberOf } from "./fields.js";

const SHOWN_ROWS = 60;

export class RowsTable {
  constructor(node, form) {
    this.node = node;
    this.form = form;
    this.body = el("tbody", {});
    this.note = el("p", { class: "hint" });
    const add = el("button", { type: "button", onclick: () => form.addTo(node) }, `Add to ${node.words}`);
    const headings = node.columns.map(each =>
      el("th", { scope: "col", title: each.hint }, each.words, each.unit && el("span", { class: "unit" }, ` ${each.unit}`)));
    this.element = el("div", { class: "rows", onpaste: event => this.paste(event) },
      el("div", { class: "scroll", tabindex: "0", role: "group", "aria-label": node.words },
        el("table", {}, el("caption", { class: "hidden" }, node.words),
          el("thead", {}, el("tr", {}, headings, el("td", {}))), this.body)),
      this.note, el("div", { class: "row-actions" }, add));
    this.cells = [];
  }

  show(doc, effective, findingsAt) {
    const given = at(doc, this.node.path), known = at(effective, this.node.path);
    const rows = given ?? known ?? [];
    const shown = Math.min(rows.length, SHOWN_ROWS);
    if (this.cells.length !== shown) this.build(shown);
    this.cells.forEach((cells, r) => cells.forEach((input, c) => {
      const column = this.node.columns[c], value = rows[r]?.[column.key];
      const text = value === undefined || value === null ? "" : written(value);
      const typed = column.kind === "number" ? numberOf(input.value) : input.value;
      if (document.activeElement !== input || typed !== (value ?? "")) if (input.value !== text) input.value = text;
      const path = `${this.node.path}.${r}.${column.key}`;
      const found = [...findingsAt(path), ...(c === 0 ? findingsAt(`${this.node.path}.${r}`) : [])];
      input.title = found.map(each => each.words).join("; ");
      if (found.length) input.setAttribute("aria-invalid", "true"); else input.removeAttribute("aria-invalid");
    }));
    const more = rows.length - shown;
    const problems = findingsAt(this.node.path, true).map(each => each.words);
    this.note.className = problems.length ? "finding" : "hint";
    this.note.textContent = problems.join("; ") || [
      given === undefined && rows.length ? "From a file; an edit puts the table into the scenario." : "",
      more > 0 ? `${more} more rows.` : "",
    ].filter(Boolean).join(" ");
  }

  build(count) {
    const { node, form } = this;
    this.cells = Array.from({ length: count }, (_, r) => node.columns.map(column => el("input", {
      type: "text", autocomplete: "off", spellcheck: "false", class: column.kind === "number" ? "number" : "",
      inputmode: column.kind === "number" ? "decimal" : null, "aria-label": `${column.words} ${r + 1} of ${node.words}`,
      oninput: event => this.edit(r, column, event.target.value),
    })));
    this.body.replaceChildren(...this.cells.map((cells, r) => el("tr", {}, cells.map(input => el("td", {}, input)),
      el("td", {}, el("button", { type: "button", class: "icon", "aria-label": `Remove row ${r + 1} of ${node.words}`,
        onclick: () => form.remove(node, r) }, "×")))));
  }

  edit(row, column, text) {
    const value = text.trim() === "" ? null : column.kind === "number" ? numberOf(text) : text;
    this.form.editRow(this.node, row, column, value);
  }

  /** Cells of a spreadsheet take the place of all rows; a single value is pasted as usual. */
  paste(event) {
    const text = event.clipboardData.getData("text/plain");
    if (!/[\t\n;]/.test(text.trim())) return;
    event.preventDefault();
    this.form.paste(this.node, text);
  }
}
