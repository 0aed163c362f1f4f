// The train graph: paths of all trains over time, coloured by the voltage at their pantographs.

import uPlot from "./vendor/uplot.js";
import { colour, el, shown } from "./dom.js";
import { AXIS, LEFT, ramp, shadeOf, spanOf } from "./scales.js";

const HEIGHT = 320, NAMES = 92;

export class TrainGraph {
  constructor(title) {
    this.title = title;
    this.legend = el("p", { class: "legend", "aria-hidden": "true" });
    this.plots = el("div", { class: "plots", role: "img" });
    this.scale = el("span", { class: "colour-scale" });
    this.element = el("figure", { class: "chart" }, el("figcaption", {}, el("h2", {}, title), this.legend), this.plots);
    new ResizeObserver(([entry]) => {
      this.width = Math.floor(entry.contentRect.width);
      this.draw();
    }).observe(this.plots);
  }

  show(drawing, ghost) {
    this.element.hidden = !drawing;
    Object.assign(this, { drawing, ghost });
    if (drawing) {
      this.curve = drawing.panels[0].items.find(each => each.colours);
      this.marks = drawing.panels[0].items.filter(each => each.kind === "mark");
      this.former = ghost?.panels[0].items.find(each => each.colours);
    }
    this.draw();
  }

  draw() {
    const width = this.width;
    if (!this.drawing || !width) return;
    this.xs = this.drawing.span || spanOf([this.curve.x], 0);
    this.ys = this.drawing.panels[0].span || spanOf([this.curve.y], 0.02);
    if (!this.plot) this.build(width);
    else {
      if (this.plot.width !== width) this.plot.setSize({ width, height: HEIGHT });
      this.plot.setData([this.xs, [null, null]], true);
    }
    const { low, high, label } = this.curve.colours;
    this.legend.replaceChildren(el("span", {}, `${shown(low, 1)} kV `, this.bar(), ` ${shown(high, 1)} kV`), el("span", {}, label.replace(/ \[.*/, "")));
    this.plots.setAttribute("aria-label", `${this.title}: ${this.count()} trains, voltage ${shown(low, 1)} to ${shown(high, 1)} kV`);
  }

  count() {
    const words = this.curve.words, seen = new Set();
    for (let i = 0; i < words.length; i += 1) seen.add(words.at(i));
    return seen.size;
  }

  bar() {
    this.scale.style.background = `linear-gradient(to right, ${ramp().join(",")})`;
    return this.scale;
  }

  build(width) {
    this.plot = new uPlot({
      width, height: HEIGHT, padding: [10, NAMES, 0, 0], legend: { show: false },
      cursor: { sync: { key: "time" }, drag: { x: false, y: false }, points: { show: false } },
      scales: { x: { time: false, range: () => this.xs }, y: { range: () => this.ys } },
      axes: [{ ...AXIS, size: 34, gap: 4 }, { ...AXIS, size: LEFT, gap: 6 }],
      series: [{}, { show: true, points: { show: false } }],
      hooks: { drawSeries: [plot => this.paths(plot)] },
    }, [this.xs, [null, null]], this.plots);
  }

  paths(plot) {
    const context = plot.ctx, { left, top, width, height } = plot.bbox, scale = devicePixelRatio;
    context.save();
    this.stations(plot);
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    if (this.former) this.ghosts(plot, scale);
    this.coloured(plot, scale);
    context.restore();
  }

  stations(plot) {
    const context = plot.ctx, { left, width } = plot.bbox, scale = devicePixelRatio;
    context.font = `${11.5 * scale}px system-ui, sans-serif`;
    context.textAlign = "left";
    for (const mark of this.marks) {
      const y = Math.round(plot.valToPos(mark.value, "y", true));
      context.strokeStyle = colour("--place");
      context.lineWidth = scale;
      context.beginPath();
      context.moveTo(left, y);
      context.lineTo(left + width, y);
      context.stroke();
      context.fillStyle = colour("--soft");
      context.fillText(mark.words, left + width + 6 * scale, y + 4 * scale, (NAMES - 10) * scale);
    }
  }

  ghosts(plot, scale) {
    const context = plot.ctx, { x, y } = this.former;
    context.beginPath();
    let joined = false;
    for (let i = 0; i < x.length; i += 1) {
      if (Number.isNaN(x[i]) || Number.isNaN(y[i])) { joined = false; continue; }
      const at = [plot.valToPos(x[i], "x", true), plot.valToPos(y[i], "y", true)];
      if (joined) context.lineTo(...at); else context.moveTo(...at);
      joined = true;
    }
    context.strokeStyle = colour("--ghost");
    context.lineWidth = 2.5 * scale;
    context.stroke();
  }

  /** Pieces of paths, those of one colour in one go. */
  coloured(plot, scale) {
    const { x, y, colours } = this.curve, context = plot.ctx;
    const shades = ramp(), pieces = shades.map(() => new Path2D());
    let before = null;
    for (let i = 0; i < x.length; i += 1) {
      const gone = Number.isNaN(x[i]) || Number.isNaN(y[i]);
      const at = gone ? null : [plot.valToPos(x[i], "x", true), plot.valToPos(y[i], "y", true)];
      const kv = colours.values[i];
      if (before && at && !Number.isNaN(kv)) {
        const piece = pieces[shadeOf(kv, colours.low, colours.high)];
        piece.moveTo(...before);
        piece.lineTo(...at);
      }
      before = at;
    }
    context.lineWidth = 1.7 * scale;
    pieces.forEach((piece, k) => { context.strokeStyle = shades[k]; context.stroke(piece); });
  }
}
