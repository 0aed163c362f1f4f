// How far a result can be trusted, always in view: end of the run, audit, violations, step, validity.

import { el, refill } from "./dom.js";

export class Verdicts {
  constructor(place) {
    this.place = place;
    this.checked = null;
    this.open = new Set();
  }

  show(result) {
    this.result = result;
    this.checked = null;
    this.draw();
  }

  check(told) {
    this.checked = told;
    this.draw();
  }

  draw() {
    const { result, checked } = this, good = result.status === "finished";
    const { audit, violations, violation_count: count } = result;
    refill(this.place,
      this.verdict("run", good ? "good" : "bad", good ? "Run finished" : `Run ${result.status}`,
        [result.status_words, result.problem, result.advice].filter(Boolean)),
      result.outage && this.verdict("outage", "warn", `Outage: ${result.outage}`, [`${result.outage_words}; the whole supply is in service again with "Intact supply" in the view of outages.`]),
      this.verdict("audit", audit.passed ? "good" : "bad", audit.passed ? "Audit passed" : "Audit failed",
        audit.passed ? ["Powers, energies and motion balance within the limits of the audit."]
          : ["The figures cannot be trusted, and are not shown.", ...audit.failures]),
      audit.passed && this.verdict("limits", count ? "bad" : "good", count ? `${count} violation${count > 1 ? "s" : ""}` : "No violations",
        count ? violations : ["No limit of the standards is violated."]),
      this.step(result, checked),
      checked && checked.notes.length > 0 && this.verdict("notes", "warn", `${checked.notes.length} note${checked.notes.length > 1 ? "s" : ""}`, checked.notes),
      this.verdict("validity", "", "Validity", result.validity));
  }

  step(result, checked) {
    const step = `Step ${Number(result.step_min.toPrecision(6))} min`;
    if (!checked) return this.verdict("step", "", `${step}, error …`, ["The run is made again with half its step once the hand rests."]);
    const kind = checked.within === false ? "warn" : checked.within ? "good" : "";
    const words = checked.within === false ? ", too long" : checked.within ? ", error small" : "";
    return this.verdict("step", kind, `${step}${words}`, checked.step_lines);
  }

  verdict(key, kind, words, lines) {
    const element = el("details", { class: `verdict ${kind}`, name: "verdict", open: this.open.has(key) },
      el("summary", {}, words), el("ul", {}, lines.map(each => el("li", {}, each))));
    element.addEventListener("toggle", () => { if (element.open) this.open.add(key); else this.open.delete(key); });
    return element;
  }
}
