// The charts that are shown: some always, others as one chooses, of those that a run has.

import { Chart } from "./chart.js";
import { el } from "./dom.js";
import { TrainGraph } from "./traingraph.js";

const ALWAYS = ["voltage", "graph", "powers", "loading"];

export class Charts {
  /** @param described titles and axes by names; wanted () is called when another one is chosen. */
  constructor(place, described, wanted) {
    Object.assign(this, { place, described, wanted, charts: {}, chosen: new Set(ALWAYS) });
    this.boxes = {};
    this.choice = el("fieldset", { class: "more-charts" }, el("legend", {}, "More charts"),
      Object.entries(described).filter(([name]) => !ALWAYS.includes(name)).map(([name, { title }]) => {
        this.boxes[name] = el("label", { hidden: true }, el("input", { type: "checkbox", onchange: event => this.choose(name, event.target.checked) }), ` ${title}`);
        return this.boxes[name];
      }));
    for (const name of ALWAYS) this.add(name);
    place.append(this.choice);
  }

  get names() { return [...this.chosen]; }

  add(name) {
    const { title, over } = this.described[name];
    this.charts[name] ??= over === "train" ? new TrainGraph(title) : new Chart(title, over);
    if (this.choice.parentNode) this.choice.before(this.charts[name].element);
    else this.place.append(this.charts[name].element);
  }

  choose(name, is) {
    if (is) {
      this.chosen.add(name);
      this.add(name);
      this.wanted();
    } else {
      this.chosen.delete(name);
      this.charts[name].element.remove();
    }
  }

  show(offered, drawings, ghosts) {
    for (const [name, box] of Object.entries(this.boxes)) box.hidden = !offered.includes(name);
    for (const name of this.chosen) this.charts[name].show(drawings[name], ghosts?.[name]);
  }

  draw() { for (const name of this.chosen) this.charts[name].draw(); }
}
