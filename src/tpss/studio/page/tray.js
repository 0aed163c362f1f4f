// The tray of variants: the file, what was edited, and the variants of the scenario, side by side.

import { Asking } from "./asking.js";
import { el, refill } from "./dom.js";
import { dataTable } from "./datatable.js";
import { ask } from "./server.js";

const COLUMNS = [
  ["name", "variant"], ["status", "ended"], ["changes", "changes", "", 0], ["lowest_kv", "lowest voltage", "kV", 2],
  ["peak_loading_percent", "peak loading", "%", 1], ["trip_min", "trip", "min", 2], ["late_min", "late", "min", 2],
  ["energy_mwh", "energy", "MWh", 2], ["losses_mwh", "losses", "MWh", 2], ["violations", "violations", "", 0],
];
const PLAIN = ["changes", "violations"];

export class Tray {
  /** @param of {page, pairs, failed, push, replace}: `replace` puts other edits in place of all. */
  constructor(of) {
    this.of = of;
    this.asking = new Asking(of, "variants");
    this.table = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Variants" });
    this.name = el("input", { type: "text", id: "variant-name", autocomplete: "off", spellcheck: "false" });
    this.state = el("p", { class: "hint" });
    this.element = el("section", { class: "card" }, el("h2", {}, "Variants"),
      el("p", { class: "hint" }, "What was edited may be kept as a variant: the scenario stays as it was, and names its changes."),
      el("form", { class: "choices", onsubmit: event => { event.preventDefault(); this.keep(); } },
        el("label", { for: "variant-name" }, "Name"), this.name, el("button", { type: "submit" }, "Keep edits as a variant"),
        el("button", { type: "button", onclick: () => this.run() }, "Run all again")),
      this.state, this.table);
  }

  async run() {
    const told = await this.asking.ask({}, is => { this.state.textContent = is ? "Computing …" : ""; });
    if (told) this.show(told.rows);
  }

  show(rows) {
    const used = COLUMNS.filter(([key]) => rows.some(row => row[key] !== null && row[key] !== undefined));
    const columns = used.map(([key, words, unit, digits]) => ({ words, unit, digits, base: !PLAIN.includes(key) }));
    const cells = rows.map(row => used.map(([key]) => key === "status" && row.fault ? row.fault : row[key]));
    refill(this.table, dataTable("Variants", columns, cells, r => rows[r].is_variant ? [
      el("button", { type: "button", class: "quiet", "aria-label": `Show ${rows[r].name}`, onclick: () => this.of.push(`variant ${rows[r].name}`, rows[r].edits) }, "Show"),
      el("button", { type: "button", class: "quiet", "aria-label": `Take out ${rows[r].name}`, onclick: () => { this.of.push(`take out ${rows[r].name}`, [[`variants.${rows[r].name}`, null]]); this.run(); } }, "Take out"),
    ] : []));
  }

  /** The edits become a variant in the file, and are undone in the scenario itself. */
  async keep() {
    const name = this.name.value.trim().replace(/[^A-Za-z0-9_-]+/g, "-");
    const { variant } = await ask("keep-variant", { edits: this.of.pairs() });
    if (!name || !Object.keys(variant).length) {
      this.state.textContent = name ? "Nothing was edited that a variant could keep." : "Give the variant a name.";
      return;
    }
    const others = this.of.pairs().filter(([path]) => path.split(".")[0] === "variants");
    this.of.replace(`keep variant ${name}`, [...others, [`variants.${name}`, variant]]);
    this.name.value = "";
    await this.run();
  }
}
