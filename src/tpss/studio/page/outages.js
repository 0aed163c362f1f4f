// Outages: every single element in turn, ranked, and any of them shown in the curves by a click.

import { Asking } from "./asking.js";
import { el, refill, written } from "./dom.js";
import { dataTable } from "./datatable.js";

/** Edits that take a place of the drawing out of service, or let all be in service again. */
export function toggled(doc, place) {
  const name = place.kind === "transformer" ? `transformer ${written(place.km)} km out` : `${place.name} out`;
  if (doc.simulation?.outage === name) return [["simulation.outage", null]];
  const known = (doc.outages || []).some(each => each.name === name);
  const out = place.kind === "transformer" ? { name, transformers_km: [place.km] } : { name, stations: [place.name] };
  return [...(known ? [] : [["outages.+", out]]), ["simulation.outage", name]];
}

const WITHOUT = /change$/;

export class Outages {
  constructor(of) {
    this.of = of;
    this.asking = new Asking(of, "outages");
    this.state = el("p", { class: "hint" });
    this.table = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Single outages" });
    this.element = el("section", { class: "card" }, el("h2", {}, "Outages (n-1)"),
      el("p", { class: "hint" }, "Each station, unit, transformer and switch out of service in turn; the gravest first. Differences are those to the intact supply."),
      el("div", { class: "choices" }, el("button", { type: "button", onclick: () => this.run() }, "Run all single outages"),
        el("button", { type: "button", onclick: () => this.of.push("intact supply", [["simulation.outage", null]]) }, "Intact supply")),
      this.state, this.table);
  }

  async run() {
    const told = await this.asking.ask({}, is => { this.state.textContent = is ? "Computing …" : ""; });
    if (!told) return;
    const kept = told.headings.map((_, k) => k).filter(k => !WITHOUT.test(told.headings[k]));
    const percent = k => told.headings[k] === "peak loading";
    const columns = kept.map(k => ({ words: told.headings[k], unit: percent(k) ? "%" : told.units[k], digits: percent(k) ? 1 : 2, base: true }));
    const rows = told.rows.map(row => kept.map(k => percent(k) && row[k] !== null ? 100 * row[k] : row[k]));
    refill(this.table, dataTable("Single outages", columns, rows, r => told.edits[r].length > 0 && el("button", { type: "button", class: "quiet",
      "aria-label": `Show ${told.rows[r][0]}`, onclick: () => this.of.push(`outage ${told.rows[r][0]}`, told.edits[r]) }, "Show")));
  }
}
