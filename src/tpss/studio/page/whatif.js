// What if: a slider for any number of the scenario, its response curve, and the fewest units that do.

import { Asking } from "./asking.js";
import { Chart } from "./chart.js";
import { at } from "./documents.js";
import { dataTable } from "./datatable.js";
import { el, refill, written } from "./dom.js";
import { numberOf } from "./fields.js";

const RUNS = 20;
const SHOWN = ["lowest", "loading", "energy"];
const COUNTS = /^(converters|transformers|rectifiers|units)$/;

export class WhatIf {
  constructor(of, schemas) {
    Object.assign(this, { of, schemas });
    this.asking = new Asking(of, "respond");
    this.halving = new Asking(of, "fewest");
    this.path = el("select", { id: "what-if-path", onchange: () => this.choose() });
    const bound = id => el("input", { type: "text", class: "number", inputmode: "decimal", id, onchange: () => this.bounds() });
    this.from = bound("what-if-from");
    this.to = bound("what-if-to");
    this.slider = el("input", { type: "range", id: "what-if", oninput: () => this.slide() });
    this.now = el("output", { for: "what-if" });
    this.state = el("p", { class: "hint" });
    this.chart = new Chart("Response", "response");
    this.chart.element.hidden = true;
    const run = el("button", { type: "button", onclick: () => this.respond() }, `Response curve (${RUNS} runs)`);
    this.element = el("div", {}, el("section", { class: "card" }, el("h2", {}, "What if"),
      el("div", { class: "choices" }, el("label", { for: "what-if-path" }, "Number"), this.path,
        el("label", { for: "what-if-from" }, "from"), this.from, el("label", { for: "what-if-to" }, "to"), this.to),
      el("div", { class: "choices slide" }, el("label", { for: "what-if", class: "hidden" }, "Value"), this.slider, this.now, run), this.state),
    this.chart.element, this.least());
  }

  least() {
    this.units = el("select", { id: "fewest-path" });
    this.kv = el("input", { type: "text", class: "number", inputmode: "decimal", id: "fewest-kv" });
    this.percent = el("input", { type: "text", class: "number", inputmode: "decimal", id: "fewest-loading", value: "100" });
    this.answer = el("p", { role: "status" });
    this.tried = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Numbers that were tried" });
    return el("section", { class: "card" }, el("h2", {}, "Fewest units"),
      el("p", { class: "hint" }, "The smallest number that keeps both limits, found by halving; more units are taken to be no worse."),
      el("div", { class: "choices" }, el("label", { for: "fewest-path" }, "Units of"), this.units, el("label", { for: "fewest-kv" }, "voltage at least [kV]"), this.kv,
        el("label", { for: "fewest-loading" }, "loading at most [%]"), this.percent, el("button", { type: "button", onclick: () => this.find() }, "Find")),
      this.answer, this.tried);
  }

  /** Numbers of the document, the chosen one kept. */
  show(doc, effective) {
    this.doc = doc;
    const paths = [...leaves(doc)].filter(([path, value]) => typeof value === "number" && path !== "format" && !path.startsWith("variants."));
    const chosen = this.path.value || "traffic.0.headway_min";
    this.options(this.path, paths.map(([path]) => [path, this.words(path)]), chosen);
    this.options(this.units, stationsOf(doc), this.units.value);
    if (!this.kv.value && effective?.standards) this.kv.value = written(effective.standards.voltage_limits.umin1_kv);
    const value = at(doc, this.path.value);
    if (this.path.value !== this.shownPath) this.choose();
    else if (document.activeElement !== this.slider) this.put(value);
  }

  options(select, entries, chosen) {
    const key = JSON.stringify(entries);
    if (select.dataset.entries === key) return;
    select.dataset.entries = key;
    select.replaceChildren(...entries.map(([value, words]) => el("option", { value }, words)));
    if (entries.some(([value]) => value === chosen)) select.value = chosen;
  }

  words(path) {
    const keys = path.split(".");
    let part = this.doc;
    const parts = keys.map(key => {
      part = part?.[key];
      if (/^\d+$/.test(key)) return typeof part === "object" && part?.name || `${Number(key) + 1}`;
      return this.schemas.label(key)[0];
    });
    const unit = this.schemas.label(keys.findLast(key => !/^\d+$/.test(key)))[1];
    return parts.slice(-3).join(" › ") + (unit ? ` [${unit}]` : "");
  }

  choose() {
    this.shownPath = this.path.value;
    const value = at(this.doc, this.shownPath) ?? 0;
    const whole = COUNTS.test(this.shownPath.split(".").at(-1));
    [this.from.value, this.to.value] = whole ? ["1", written(Math.max(2, 2 * value))]
      : value === 0 ? ["0", "1"] : [0.5 * value, 1.5 * value].sort((one, other) => one - other).map(written);
    this.slider.dataset.whole = String(whole);
    this.chart.element.hidden = true;
    this.bounds();
    this.put(value);
  }

  bounds() {
    const [from, to] = [this.from, this.to].map(each => numberOf(each.value));
    if (typeof from !== "number" || typeof to !== "number") return;
    Object.assign(this.slider, { min: from, max: to, step: this.slider.dataset.whole === "true" ? 1 : Number(((to - from) / 100).toPrecision(1)) || 0.01 });
  }

  put(value) {
    if (value === undefined) return;
    this.slider.value = value;
    this.now.textContent = written(value);
  }

  slide() {
    const value = Number(this.slider.value);
    this.now.textContent = written(value);
    this.of.push(`${this.words(this.shownPath)} ${written(value)}`, [[this.shownPath, value]], this.shownPath);
  }

  values() {
    const [from, to] = [numberOf(this.from.value), numberOf(this.to.value)];
    const all = Array.from({ length: RUNS }, (_, k) => Number((from + k * (to - from) / (RUNS - 1)).toPrecision(8)));
    return this.slider.dataset.whole === "true" ? [...new Set(all.map(Math.round))] : all;
  }

  async respond() {
    const told = await this.asking.ask({ path: this.shownPath, values: this.values() }, is => { this.state.textContent = is ? "Computing …" : ""; });
    if (!told) return;
    const x = Float64Array.from(told.values);
    const here = at(this.doc, told.path);
    const gone = told.ended.filter(each => each !== "finished").length;
    this.state.textContent = gone ? `${gone} of ${told.ended.length} runs did not finish, or are no scenarios: there are gaps.` : "";
    this.chart.show({ axis: this.words(told.path), span: null, panels: SHOWN.map((name, k) => {
      const { words, unit, values } = told.figures[name];
      return { label: `${words} [${unit}]`, span: null, from_zero: false, items: [
        { kind: "mark", upright: true, value: here, words: "", dash: 1 },
        { kind: "curve", x, y: Float64Array.from(values, each => each ?? NaN), name: words, colour: k, dash: 0, held: false, joined: true }] };
    }) }, null);
  }

  async find() {
    const limit = input => input.value.trim() === "" ? null : numberOf(input.value);
    const told = await this.halving.ask({ path: this.units.value, lowest_kv: limit(this.kv), loading_percent: limit(this.percent) },
      is => { this.answer.textContent = is ? "Computing …" : ""; });
    if (!told) return;
    this.answer.textContent = told.fewest === null ? "No number that was tried keeps the limits." : `${told.fewest} keep the limits, one fewer does not.`;
    const columns = [["units"], ["ended"], ["limits kept"], ["lowest voltage", "kV"], ["useful voltage", "kV"], ["highest loading", "%"], ["trip", "min"], ["energy", "MWh"], ["losses", "MWh"]]
      .map(([words, unit]) => ({ words, unit, digits: 2 }));
    refill(this.tried, dataTable("Numbers that were tried", columns, told.rows),
      told.fewest !== null && el("button", { type: "button", onclick: () => this.of.push(`${told.fewest} units`, [[this.units.value, told.fewest]]) }, `Take ${told.fewest}`));
  }
}

function* leaves(part, path = "") {
  if (part === null || typeof part !== "object") { yield [path, part]; return; }
  for (const [key, inside] of Object.entries(part)) if (!key.includes(".")) yield* leaves(inside, path ? `${path}.${key}` : key);
}

/** Key paths of numbers of units: of every station of a kind, and of each. */
function stationsOf(doc) {
  return Object.entries(doc.supply || {}).filter(([, each]) => Array.isArray(each)).flatMap(([key, items]) => {
    const count = Object.keys(items[0] || {}).find(each => COUNTS.test(each) && typeof items[0][each] === "number");
    if (!count) return [];
    return [[`supply.${key}.*.${count}`, `every station (${count})`], ...items.map((item, i) => [`supply.${key}.${i}.${count}`, `${item.name ?? i + 1} (${count})`])];
  });
}
