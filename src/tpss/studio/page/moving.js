// Trains over the drawing of the line at a moment, which a slider or time itself moves.

import { unpacked } from "./arrays.js";
import { el, shown, svg } from "./dom.js";
import { ramp, shadeOf, spanOf } from "./scales.js";

const COLUMNS = ["step", "line", "km", "kv", "kmh", "aside"];
const SECONDS = 30;
/** Time in which a whole run is played. [s] */

export class Moving {
  /** @param plan where trains are drawn; wanted () is called when they are asked for, or no longer. */
  constructor(plan, wanted) {
    Object.assign(this, { plan, wanted, on: false, told: null, playing: 0, dots: new Map() });
    this.button = el("button", { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => this.toggle() }, "Trains");
    this.slider = el("input", { type: "range", id: "moment", min: 0, max: 1, step: 1, value: 0, oninput: () => this.draw() });
    this.play = el("button", { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => this.start() }, "Play");
    this.now = el("output", { for: "moment" });
    this.state = el("p", { class: "hint" });
    this.clock = el("div", { class: "choices slide clock", hidden: true }, this.play, el("label", { for: "moment", class: "hidden" }, "Time"), this.slider, this.now);
    plan.element.querySelector("figcaption").append(this.button);
    plan.element.append(this.clock, this.state);
    plan.moved = () => this.draw();
  }

  toggle() {
    this.on = !this.on;
    this.button.setAttribute("aria-pressed", String(this.on));
    this.clock.hidden = !this.on;
    if (!this.on) this.stop();
    this.wanted();
    this.draw();
  }

  show(told) {
    if (!told) return;
    this.told = { ...told, trains: told.trains.map(train => ({ name: train.name, ...Object.fromEntries(COLUMNS.map(key => [key, unpacked(train[key])])) })) };
    this.slider.max = told.steps;
    const [low, high] = spanOf(this.told.trains.map(each => each.kv), 0);
    this.span = [Math.min(low, high - 0.1 * high), high];
    this.draw();
  }

  draw() {
    const layer = this.plan.trains;
    if (!this.on || !this.told || !this.plan.lines) {
      layer.replaceChildren();
      this.dots.clear();
      this.state.textContent = "";
      return;
    }
    const step = Number(this.slider.value), shades = ramp();
    const minutes = `${shown(step * this.told.step_min, 1)} min`;
    this.now.textContent = minutes;
    this.slider.setAttribute("aria-valuetext", minutes);
    let count = 0, lowest = Infinity, where = "";
    for (const train of this.told.trains) {
      const at = placeOf(train, step);
      let dot = this.dots.get(train.name);
      if (!at) { dot?.remove(); this.dots.delete(train.name); continue; }
      if (!dot) {
        dot = svg("circle", { r: 5, class: "train" }, svg("title", {}));
        this.dots.set(train.name, dot);
        layer.append(dot);
      }
      const line = this.plan.plan.lines[at.line], [x, y] = this.plan.at(line, at.km);
      dot.setAttribute("cx", x);
      dot.setAttribute("cy", y - 46 * at.aside);
      dot.setAttribute("fill", Number.isNaN(at.kv) ? "none" : shades[shadeOf(at.kv, ...this.span)]);
      dot.firstChild.textContent = `${train.name}, km ${shown(at.km, 1)}, ${shown(at.kmh, 0)} km/h, ${shown(at.kv)} kV`;
      count += 1;
      if (at.kv < lowest) [lowest, where] = [at.kv, `${train.name} at km ${shown(at.km, 1)}`];
    }
    this.state.textContent = count ? `${count} trains; lowest voltage ${shown(lowest)} kV, ${where}` : "No train is on the line.";
  }

  start() {
    if (this.playing) { this.stop(); return; }
    this.play.setAttribute("aria-pressed", "true");
    if (this.slider.value === this.slider.max) this.slider.value = 0;
    let before = performance.now(), at = Number(this.slider.value);
    const next = now => {
      at += (now - before) / 1e3 * this.told.steps / SECONDS;
      before = now;
      this.slider.value = at;
      this.draw();
      if (at >= this.told.steps) this.stop(); else this.playing = requestAnimationFrame(next);
    };
    this.playing = requestAnimationFrame(next);
  }

  stop() {
    cancelAnimationFrame(this.playing);
    this.playing = 0;
    this.play.setAttribute("aria-pressed", "false");
  }
}

/** Place of a train at a step, between the steps that are known; null while it is not there. */
function placeOf(train, step) {
  const steps = train.step;
  if (step < steps[0] || step > steps[steps.length - 1]) return null;
  let low = 0, high = steps.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (steps[middle] <= step) low = middle; else high = middle;
  }
  if (train.line[low] !== train.line[high]) high = low;
  const share = high === low ? 0 : (step - steps[low]) / (steps[high] - steps[low]);
  const of = key => train[key][low] + share * (train[key][high] - train[key][low]);
  return { line: train.line[low], km: of("km"), kv: of("kv"), kmh: of("kmh"), aside: of("aside") };
}
