// A drawing of the server as curves over one axis: panels above each other, with the baseline as grey ghosts.

import uPlot from "./vendor/uplot.js";
import { withGaps } from "./arrays.js";
import { colour, el, shown } from "./dom.js";
import { AXIS, DASHES, LEFT, RIGHT, curveColour, spanOf } from "./scales.js";

const HEIGHT = 190, LOW_HEIGHT = 130;
const MOST_ROWS = 60;

const curvesOf = panel => panel.items.filter(each => each.kind === "curve" && each.joined);

/** Curves of a panel over one axis, as uPlot takes them. */
function dataOf(curves) {
  const first = curves[0].x;
  const same = curves.every(each => each.x.length === first.length && each.x.every((x, i) => x === first[i]));
  if (same) return [first, ...curves.map(each => withGaps(each.y))];
  return uPlot.join(curves.map(each => [Array.from(each.x), withGaps(each.y)]));
}

function rangeOf(panel, ghost) {
  if (panel.span) return panel.span;
  const ys = [...curvesOf(panel), ...(ghost ? curvesOf(ghost) : [])].map(each => each.y);
  const marks = panel.items.filter(each => each.kind === "mark" && !each.upright).map(each => each.value);
  const [low, high] = spanOf(ys, 0.08, panel.from_zero ? [0, ...marks] : []);
  return [panel.from_zero ? Math.min(0, low) : low, high];
}

class Panel {
  constructor(place, axis, isLast, follow) {
    this.place = place;
    this.axis = axis;
    this.isLast = isLast;
    this.follow = follow;
  }

  show(panel, ghost, span, width, height) {
    const curves = curvesOf(panel);
    if (!curves.length) return;
    Object.assign(this, { panel, ghost, span, range: rangeOf(panel, ghost) });
    const key = JSON.stringify([panel.label, curves.map(each => [each.name, each.colour, each.dash, each.held]), height]);
    const data = dataOf(curves);
    if (key !== this.key) this.build(key, curves, data, width, height);
    else {
      if (this.plot.width !== width) this.plot.setSize({ width, height });
      this.plot.setData(data, true);
    }
  }

  build(key, curves, data, width, height) {
    this.key = key;
    if (this.plot) this.plot.destroy();
    this.plot = new uPlot({
      width, height, padding: [10, RIGHT, 0, 0], legend: { show: false },
      cursor: { sync: { key: this.axis }, drag: { x: false, y: false }, points: { size: 6 } },
      scales: { x: { time: false, range: () => this.span || [data[0][0], data[0].at(-1)] }, y: { range: () => this.range } },
      axes: [{ ...AXIS, size: this.isLast ? 34 : 10, values: this.isLast ? AXIS.values : (_, ticks) => ticks.map(() => ""),
        gap: 4 }, { ...AXIS, size: LEFT, gap: 6 }],
      series: [{}, ...curves.map(each => ({
        label: each.name, stroke: () => curveColour(each.colour), width: 1.6, dash: DASHES[each.dash % 4], points: { show: false },
        paths: each.held ? uPlot.paths.stepped({ align: 1 }) : undefined,
      }))],
      hooks: { drawAxes: [plot => this.behind(plot)], setCursor: [plot => this.follow(plot, this.panel)] },
    }, data, this.place);
  }

  /** Bands, ghosts and limits, below the curves. */
  behind(plot) {
    const context = plot.ctx, { left, top, width, height } = plot.bbox;
    context.save();
    context.beginPath();
    context.rect(left, top, width, height);
    context.clip();
    for (const band of this.panel.items.filter(each => each.kind === "band")) this.band(plot, band);
    if (this.ghost) for (const curve of curvesOf(this.ghost)) this.ghostly(plot, curve);
    for (const mark of this.panel.items.filter(each => each.kind === "mark")) this.mark(plot, mark);
    context.restore();
  }

  trace(plot, x, y, held) {
    const context = plot.ctx;
    let joined = false, before = 0;
    for (let i = 0; i < x.length; i += 1) {
      if (y[i] === null || Number.isNaN(y[i])) { joined = false; continue; }
      const at = [plot.valToPos(x[i], "x", true), plot.valToPos(y[i], "y", true)];
      if (joined && held) context.lineTo(at[0], before);
      if (joined) context.lineTo(...at); else context.moveTo(...at);
      [joined, before] = [true, at[1]];
    }
  }

  band(plot, band) {
    const context = plot.ctx;
    context.beginPath();
    this.trace(plot, band.x, band.lowest, false);
    for (let i = band.x.length - 1; i >= 0; i -= 1)
      context.lineTo(plot.valToPos(band.x[i], "x", true), plot.valToPos(band.highest[i], "y", true));
    context.globalAlpha = 0.13;
    context.fillStyle = curveColour(band.colour);
    context.fill();
    context.globalAlpha = 1;
  }

  ghostly(plot, curve) {
    const context = plot.ctx;
    context.beginPath();
    this.trace(plot, curve.x, curve.y, curve.held);
    context.strokeStyle = colour("--ghost");
    context.lineWidth = 2.2 * devicePixelRatio;
    context.setLineDash(DASHES[curve.dash % 4].map(each => each * devicePixelRatio));
    context.stroke();
    context.setLineDash([]);
  }

  mark(plot, mark) {
    const context = plot.ctx, { left, top, width, height } = plot.bbox, scale = devicePixelRatio;
    const at = Math.round(plot.valToPos(mark.value, mark.upright ? "x" : "y", true));
    context.beginPath();
    if (mark.upright) { context.moveTo(at, top); context.lineTo(at, top + height); }
    else { context.moveTo(left, at); context.lineTo(left + width, at); }
    context.strokeStyle = colour(mark.upright ? "--place" : "--limit");
    context.lineWidth = scale;
    context.setLineDash(DASHES[mark.dash % 4].map(each => each * scale));
    context.stroke();
    context.setLineDash([]);
    if (!mark.words || mark.upright) return;
    context.font = `${11 * scale}px system-ui, sans-serif`;
    context.fillStyle = colour("--soft");
    context.textAlign = "right";
    context.fillText(mark.words, left + width - 6 * scale, at - 4 * scale);
  }
}

/** A chart with its title, legend with values at the cursor, and table. */
export class Chart {
  constructor(title, axis) {
    this.axis = axis;
    this.legend = el("p", { class: "legend", "aria-hidden": "true" });
    this.plots = el("div", { class: "plots", role: "img" });
    this.table = el("div", { class: "scroll", hidden: true, tabindex: "0", role: "region", "aria-label": `${title}, values` });
    this.title = title;
    this.button = el("button", { type: "button", class: "quiet", "aria-pressed": "false", onclick: () => this.toggle() }, "Table");
    this.button.setAttribute("aria-label", `${title} as a table`);
    this.element = el("figure", { class: "chart" },
      el("figcaption", {}, el("h2", {}, title), this.legend, this.button), this.plots, this.table);
    this.panels = [];
    new ResizeObserver(([entry]) => {
      this.width = Math.floor(entry.contentRect.width);
      this.draw();
    }).observe(this.plots);
  }

  show(drawing, ghost) {
    this.element.hidden = !drawing;
    Object.assign(this, { drawing, ghost });
    this.draw();
    if (drawing && !this.table.hidden) this.tabulate();
  }

  draw() {
    const width = this.width;
    if (!this.drawing || !width) return;
    const panels = this.drawing.panels;
    if (this.panels.length !== panels.length) {
      this.plots.replaceChildren();
      this.panels = panels.map((panel, i) => {
        const label = el("p", { class: "axis" }, panel.label), place = el("div", {});
        this.plots.append(label, place);
        return new Panel(place, this.axis, i === panels.length - 1, (plot, own) => this.follow(plot, own));
      });
    }
    const height = panels.length > 1 ? LOW_HEIGHT : HEIGHT;
    this.panels.forEach((each, i) => each.show(panels[i], this.ghost?.panels[i], this.drawing.span, width, height));
    this.plots.setAttribute("aria-label", this.words());
    this.follow(null, panels[0]);
  }

  /** What the picture shows, in words. */
  words() {
    const parts = this.drawing.panels.flatMap(panel => curvesOf(panel).map(curve => {
      const [low, high] = spanOf([curve.y], 0);
      return `${curve.name || panel.label} ${shown(low)} to ${shown(high)}`;
    }));
    return `${this.title}, over ${this.drawing.axis}: ${parts.join("; ")}`;
  }

  follow(plot, panel) {
    const i = plot?.cursor.idx;
    const has = plot && i !== null && i !== undefined;
    const entries = curvesOf(panel).filter(each => each.name).map((curve, k) => el("span", {},
      this.swatch(curve), `${curve.name}`, has && el("b", {}, ` ${shown(plot.data[k + 1][i])}`)));
    const where = has ? `${this.drawing.axis.replace(/ \[.*/, "")} ${shown(plot.data[0][i], 1)} ${this.drawing.axis.match(/\[(.*)\]/)?.[1] || ""}` : "";
    this.legend.replaceChildren(...entries, has ? el("span", {}, where) : "");
  }

  swatch(curve) {
    const mark = el("i", { class: "swatch" });
    mark.style.borderTopColor = curveColour(curve.colour);
    mark.style.borderTopStyle = ["solid", "dashed", "dashed", "dotted"][curve.dash % 4];
    return mark;
  }

  toggle() {
    this.table.hidden = !this.table.hidden;
    this.button.setAttribute("aria-pressed", String(!this.table.hidden));
    if (!this.table.hidden) this.tabulate();
  }

  tabulate() {
    const curves = this.drawing.panels.flatMap(panel => curvesOf(panel).map(curve => ({ curve, panel })));
    const x = curves[0].curve.x, every = Math.ceil(x.length / MOST_ROWS);
    const rows = Array.from({ length: Math.ceil(x.length / every) }, (_, r) => r * every);
    this.table.replaceChildren(el("table", {}, el("caption", { class: "hidden" }, this.title),
      el("thead", {}, el("tr", {}, el("th", { scope: "col" }, this.drawing.axis),
        curves.map(({ curve, panel }) => el("th", { scope: "col" }, [curve.name, panel.label].filter(Boolean).join(", "))))),
      el("tbody", {}, rows.map(r => el("tr", {}, el("th", { scope: "row" }, shown(x[r], 1)),
        curves.map(({ curve }) => el("td", { class: "number" }, Number.isNaN(curve.y[r]) ? "–" : shown(curve.y[r]))))))));
  }
}
