// The researcher's corner: the equations behind a chart, and every step of a train.

import { Asking } from "./asking.js";
import { dataTable } from "./datatable.js";
import { el, refill } from "./dom.js";
import { ask } from "./server.js";

/** Words, or a formula as the browser draws it; the server made it from the program's own text. */
const drawn = ({ words, formula }) => formula
  ? new DOMParser().parseFromString(formula, "text/html").querySelector("math") : words;

export class Research {
  constructor(of, charts) {
    this.of = of;
    this.asking = new Asking(of, "train-steps");
    this.chart = el("select", { id: "equations-of", onchange: () => this.explain() },
      charts.map(([name, title]) => el("option", { value: name }, title)));
    this.texts = el("div", {});
    this.train = el("select", { id: "steps-of", onchange: () => this.list() });
    this.state = el("p", { class: "hint" });
    this.table = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Steps of a train" });
    this.csv = el("button", { type: "button", class: "quiet", disabled: true, onclick: () => this.download() }, "Download CSV");
    this.element = el("div", {},
      el("section", { class: "card" }, el("h2", {}, "Equations"),
        el("div", { class: "choices" }, el("label", { for: "equations-of" }, "Behind"), this.chart), this.texts),
      el("section", { class: "card" }, el("h2", {}, "Steps of a train"),
        el("p", { class: "hint" }, "Position and speed are those at the instant, all else applies until the next one."),
        el("div", { class: "choices" }, el("label", { for: "steps-of" }, "Train"), this.train,
          el("button", { type: "button", onclick: () => this.list() }, "Run again"), this.csv), this.state, this.table));
  }

  shown() {
    if (!this.texts.childElementCount) this.explain();
    this.list();
  }

  async explain() {
    const chart = this.chart.value;
    try {
      const { behind } = await ask("equations", { chart });
      if (chart === this.chart.value) refill(this.texts, behind.map(each => el("details", { class: "group" },
        el("summary", {}, el("code", {}, each.function), el("span", { class: "hint" }, ` ${each.file}`)),
        el("pre", { class: "equation", tabindex: "0", "aria-label": each.function }, each.pieces.map(drawn)),
        el("p", { class: "hint" }, `How it is read: ${each.page} of the documentation.`))));
    } catch (error) { this.of.failed(error); }
  }

  async list() {
    const told = await this.asking.ask({ train: this.train.value }, is => { this.state.textContent = is ? "Computing …" : ""; });
    if (!told) return;
    this.told = told;
    this.csv.disabled = false;
    if ([...this.train.options].map(each => each.value).join("\n") !== told.trains.join("\n"))
      this.train.replaceChildren(...told.trains.map(name => el("option", { value: name }, name)));
    this.train.value = told.train;
    const columns = told.headings.map((words, k) => ({ words, unit: told.units[k], digits: told.digits[k] }));
    refill(this.table, dataTable(`Steps of ${told.train}`, columns, told.rows));
  }

  download() {
    const { headings, units, rows, train } = this.told;
    const quoted = value => value === null ? "" : `"${String(value).replaceAll('"', '""')}"`;
    const lines = [headings.map((each, k) => quoted(units[k] ? `${each} [${units[k]}]` : each)), ...rows.map(row => row.map(quoted))];
    const link = el("a", { href: URL.createObjectURL(new Blob([lines.map(each => each.join(",")).join("\n")], { type: "text/csv" })), download: `${train}.csv` });
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }
}
