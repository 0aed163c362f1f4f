// The scenario as forms, made from its schema: sections, groups, fields and tables.

import { el, refill, written } from "./dom.js";
import { at } from "./documents.js";
import { Field } from "./fields.js";
import { isScalar, nodeOf, oneMore } from "./nodes.js";
import { RowsTable } from "./tables.js";

const OPEN_AT_FIRST = ["supply", "traffic"];
const MOST_OPEN = 6;
const NAMES = ["name", "description"];
const NOT_SHOWN = ["format", "variants", ...NAMES];

export class Form {
  /** @param place element; push(label, pairs, key) edits the scenario; read(text) parses pasted text. */
  constructor(place, schemas, push, read) {
    Object.assign(this, { place, schemas, push, read });
    this.sections = {};
    this.open = new Set(OPEN_AT_FIRST);
    this.built = new Set();
    this.faults = el("div", { class: "faults", hidden: true });
    const root = schemas.root.properties;
    const order = ["line", "lines", "supply", "trains", "traffic", ...Object.keys(root)];
    for (const key of new Set(order)) if (!NOT_SHOWN.includes(key)) this.sections[key] = this.section(key, root[key]);
    this.sections.name = this.section("", { ...schemas.root, type: "object", required: NAMES, additionalProperties: false,
      properties: Object.fromEntries(NAMES.map(key => [key, root[key]])) });
    place.append(this.faults, ...Object.values(this.sections).map(each => each.element));
  }

  section(key, schema) {
    const words = key ? this.schemas.label(key)[0] : "name";
    const inside = el("div", { class: "inside" });
    const summary = el("summary", { title: schema.description }, el("h2", {}, words), el("span", { class: "count" }));
    const element = el("details", { class: "section", open: this.open.has(key) }, summary, inside);
    element.addEventListener("toggle", () => { if (element.open) this.update(); });
    return { key, schema, element, inside, summary, signature: "", parts: [] };
  }

  show(doc, effective, findings) {
    Object.assign(this, { doc, effective: effective || this.effective, findings });
    this.update();
  }

  update() {
    if (!this.doc) return;
    this.claimed = new Set();
    for (const section of Object.values(this.sections)) {
      const value = at(this.doc, section.key), known = at(this.effective, section.key);
      section.element.hidden = section.key === "lines" ? value === undefined : section.key === "line" && !!this.doc.lines;
      section.element.classList.toggle("given", value !== undefined);
      const own = this.findings.filter(each => section.key ? each.path.split(".")[0] === section.key : NAMES.includes(each.path)).length;
      section.summary.lastChild.textContent = own ? `${own} fault${own > 1 ? "s" : ""}` : "";
      if (section.element.open && !section.element.hidden) this.fill(section, value, known);
    }
    this.tellFaults();
  }

  fill(section, value, known) {
    const node = nodeOf(this.schemas, section.schema, value, known, section.key, section.key);
    const signature = JSON.stringify(node, (name, each) => name === "effective" ? undefined : each);
    if (signature !== section.signature) {
      const focused = this.focusedPath();
      const open = new Set([...section.inside.querySelectorAll("details[open]")].map(each => each.dataset.path));
      section.parts = [];
      refill(section.inside, this.elementsOf(node, section.parts, open, true));
      section.signature = signature;
      this.focus(section, focused);
    }
    for (const part of section.parts) this.bringUpToDate(part);
  }

  bringUpToDate(part) {
    const path = part.node.path;
    if (part instanceof RowsTable) part.show(this.doc, this.effective, (place, all) => this.findingsAt(place, all));
    else part.show(at(this.doc, path), at(this.effective, path), this.findingsAt(path));
  }

  findingsAt(path, below = false) {
    const found = this.findings.filter(each => each.path === path || (below && each.path.startsWith(`${path}.`)));
    for (const each of found) this.claimed.add(each);
    return found;
  }

  /** Elements of a node; what is shown in them is among the parts. */
  elementsOf(node, parts, open, top = false) {
    if (isScalar(node)) return [this.keep(new Field(node, (...edit) => this.edit(...edit)), parts)];
    if (node.kind === "table") return [this.titled(node, top, [this.keep(new RowsTable(node, this), parts)], open)];
    if (node.kind === "values") return [this.titled(node, top, this.valuesOf(node, parts), open)];
    if (node.kind === "items") {
      const add = el("button", { type: "button", onclick: () => this.addTo(node) }, `Add to ${node.words}`);
      return [this.titled(node, top, [...node.children.flatMap(each => this.elementsOf(each, parts, open)), add], open)];
    }
    const children = node.children.flatMap(each => this.elementsOf(each, parts, open));
    return top ? [...children, this.more(node, parts, open)] : [this.titled(node, top, [...children, this.more(node, parts, open)], open)];
  }

  keep(part, parts) {
    parts.push(part);
    return part.element;
  }

  titled(node, top, children, open) {
    if (top) return el("div", {}, children);
    const item = node.path.match(/^(.*)\.(\d+)$/);
    const remove = item && node.named && el("button", { type: "button", class: "icon", "aria-label": `Remove ${node.words}`,
      onclick: () => this.push(`remove ${node.words}`, [[node.path, null]]) }, "×");
    return el("details", { class: "group", "data-path": node.path, open: this.isOpen(node, open) },
      el("summary", { title: node.hint }, node.words, node.unit && ` (${node.unit})`), remove || null, el("div", { class: "inside" }, children));
  }

  /** Groups stay as one left them; at first short lists of the file are open. */
  isOpen(node, open) {
    if (open.has(node.path)) return true;
    if (this.built.has(node.path)) return false;
    this.built.add(node.path);
    return node.named || (node.kind === "items" && node.count > 0 && node.count <= MOST_OPEN) || (node.kind === "table" && !node.fromFile && node.count > 0);
  }

  /** Keys that the file does not give, with the values that they take. */
  more(node, parts, open) {
    if (!node.more.length) return null;
    const path = `${node.path}.more`;
    const inside = el("div", { class: "inside" });
    const element = el("details", { class: "more", "data-path": path }, el("summary", {}, `${node.more.length} more`), inside);
    const build = () => {
      if (!element.open || inside.childElementCount) return;
      const own = [];
      inside.append(...node.more.flatMap(each => this.elementsOf(each, own, open)));
      parts.push(...own);
      for (const part of own) this.bringUpToDate(part);
    };
    element.addEventListener("toggle", build);
    if (open.has(path)) { element.open = true; build(); }
    return element;
  }

  valuesOf(node, parts) {
    const fields = Array.from({ length: node.count }, (_, i) => {
      const own = nodeOf(this.schemas, node.item, at(this.doc, `${node.path}.${i}`), undefined, `${node.path}.${i}`, node.key);
      const row = this.keep(new Field({ ...own, words: `${node.words} ${i + 1}` }, (...edit) => this.edit(...edit)), parts);
      return el("div", { class: "value-row" }, row, el("button", { type: "button", class: "icon",
        "aria-label": `Remove ${node.words} ${i + 1}`, onclick: () => this.push(`remove from ${node.words}`, [[`${node.path}.${i}`, null]]) }, "×"));
    });
    return [...fields, el("button", { type: "button", onclick: () => this.addTo(node) }, `Add to ${node.words}`)];
  }

  edit(path, value, words) {
    this.push(`${words} ${value === null ? "left out" : written(value)}`, [[path, value]], path);
  }

  /** Rows of a table as they are; those of a file come into the scenario first. */
  rowsOf(node) {
    return at(this.doc, node.path) ?? structuredClone(at(this.effective, node.path) ?? []);
  }

  inPlaceOfFile(node, rows) {
    const file = `${node.path}_file`;
    return at(this.doc, file) === undefined ? [[node.path, rows]] : [[file, null], [node.path, rows]];
  }

  editRow(node, row, column, value) {
    const label = `${column.words} ${value === null ? "left out" : written(value)}`;
    if (at(this.doc, node.path) !== undefined) {
      const path = `${node.path}.${row}.${column.key}`;
      this.push(label, [[path, value]], path);
      return;
    }
    const rows = this.rowsOf(node);
    rows[row] = { ...rows[row], [column.key]: value };
    this.push(label, this.inPlaceOfFile(node, rows));
  }

  addTo(node) {
    const rows = this.rowsOf(node);
    const one = oneMore(rows, node.item || this.schemas.resolved(this.schemas.of(this.schemaAt(node.path)).items), this.schemas);
    if (at(this.doc, node.path)?.length) this.push(`add to ${node.words}`, [[`${node.path}.+`, one]]);
    else this.push(`add to ${node.words}`, this.inPlaceOfFile(node, [...rows, one]));
  }

  remove(node, row) {
    if (at(this.doc, node.path) !== undefined) this.push(`remove from ${node.words}`, [[`${node.path}.${row}`, null]]);
    else this.push(`remove from ${node.words}`, this.inPlaceOfFile(node, this.rowsOf(node).filter((_, r) => r !== row)));
  }

  async paste(node, text) {
    const rows = await this.read(text, node.columns, node.path);
    if (rows) this.push(`paste ${rows.length} rows into ${node.words}`, this.inPlaceOfFile(node, rows));
  }

  schemaAt(path) {
    let schema = this.schemas.root, value = this.doc;
    for (const key of path.split(".")) {
      value = value?.[key];
      const found = this.schemas.of(schema, undefined);
      schema = found.properties?.[key] ?? found.additionalProperties ?? found.items ?? {};
    }
    return schema;
  }

  /** Findings that no field shows, above all, and how many there are. */
  tellFaults() {
    const others = this.findings.filter(each => !this.claimed.has(each));
    const count = this.findings.length;
    this.faults.hidden = count === 0;
    this.faults.replaceChildren(el("p", {}, `${count} fault${count === 1 ? "" : "s"}: the result is that before.`),
      el("ul", {}, others.map(each => el("li", {}, el("strong", {}, each.key), each.value && ` = ${each.value}`, `: ${each.words}`))));
  }

  focusedPath() {
    for (const section of Object.values(this.sections)) for (const part of section.parts)
      if (part.input === document.activeElement) return part.node.path;
    return "";
  }

  focus(section, path) {
    const part = path && section.parts.find(each => each.input && each.node.path === path);
    if (part) part.input.focus();
  }
}
