// A report or a workbook of what is shown, with the words of its author.

import { Asking } from "./asking.js";
import { el, element, refill } from "./dom.js";

const WORDS = [["title", "Title"], ["project", "Project"], ["author", "Author"], ["remarks", "Remarks"]];

export class Reports {
  constructor(of) {
    this.of = of;
    this.asking = new Asking(of, "report");
    this.said = {};
  }

  open() {
    const dialog = element("dialog");
    const fields = WORDS.map(([key, words]) => {
      const input = el(key === "remarks" ? "textarea" : "input", { id: `report-${key}`, rows: key === "remarks" ? 4 : null, type: key === "remarks" ? null : "text",
        value: this.said[key] || "", oninput: event => { this.said[key] = event.target.value; } });
      return el("div", { class: "said" }, el("label", { for: `report-${key}` }, words), input);
    });
    this.state = el("p", { role: "status" });
    const make = (kind, words) => el("button", { type: "button", onclick: () => this.make(kind) }, words);
    dialog.replaceChildren(el("h2", { id: "dialog-title" }, "Report"), ...fields, this.state,
      el("div", { class: "choices end" }, make("html", "Report (HTML)"), make("xlsx", "Workbook (xlsx)"),
        el("button", { type: "button", class: "main", onclick: () => dialog.close() }, "Close")));
    dialog.showModal();
  }

  async make(kind) {
    const told = await this.asking.ask({ kind, words: this.said }, is => { this.state.textContent = is ? "Making it …" : ""; });
    if (!told) return;
    refill(this.state, el("a", { href: told.address, download: told.name }, `Download ${told.name}`), kind === "html" && " or ",
      kind === "html" && el("a", { href: told.address, target: "_blank", rel: "noopener" }, "open it"), kind === "html" && " (print it there for a PDF)");
  }
}
