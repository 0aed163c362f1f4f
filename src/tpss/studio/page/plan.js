// The drawing to edit: a line on the axis of the curves below it, or a network as a plan.

import { el, svg } from "./dom.js";
import { Places } from "./places.js";
import { GRADIENTS, LIMITS, gradients, limits } from "./profile.js";
import { LEFT, RIGHT } from "./scales.js";

const TRACK = 40, BELOW = 26, NAMES = 46, GAP = 10, ROW = 74, TRACK_GAP = 4;

export class Plan {
  /** @param of {move, toggle}, as of `Places`. */
  constructor(of) {
    this.scene = svg("g", {});
    this.layer = svg("g", {});
    this.labels = svg("g", { "aria-hidden": "true" });
    this.trains = svg("g", { "aria-hidden": "true" });
    this.image = svg("svg", { class: "plan", role: "group", "aria-label": "Drawing of the line" }, this.scene, this.labels, this.layer, this.trains);
    this.choice = el("select", { "aria-label": "Line of the profile", onchange: () => this.draw() });
    this.chosen = el("span", { class: "chosen", hidden: true }, "profile of ", this.choice);
    this.element = el("figure", { class: "chart" }, el("figcaption", {}, el("h2", {}, "Line"),
      el("p", { class: "legend" }, "Drag stations and feeding points, or move them with the arrow keys; o takes one out of service."), this.chosen), this.image);
    this.places = new Places(this.layer, of, (event, line) => this.kmAt(event, line));
    new ResizeObserver(([entry]) => {
      this.width = Math.floor(entry.contentRect.width);
      this.draw();
    }).observe(this.element);
  }

  show(plan) {
    this.plan = plan;
    const names = plan.lines.map(each => each.name);
    this.chosen.hidden = names.length < 2;
    if (names.join() !== [...this.choice.options].map(each => each.value).join())
      this.choice.replaceChildren(...names.map(name => el("option", {}, name)));
    this.draw();
  }

  draw() {
    const width = this.width;
    if (!this.plan || !width) return;
    this.single = this.plan.lines.length === 1;
    this.lines = new Map(this.plan.lines.map(line => [line.name, line]));
    const shownLine = this.lines.get(this.choice.value) || this.plan.lines[0];
    this.fit(shownLine);
    const bottom = this.single ? TRACK + BELOW + NAMES : this.height;
    const profileX = km => this.along(shownLine, km);
    const bare = [...this.plan.lines.flatMap(line => this.track(line)), ...this.stretches(), this.highVoltage()];
    this.scene.replaceChildren(...bare.filter(Boolean), gradients(shownLine, profileX, bottom),
      limits(shownLine, profileX, bottom + GRADIENTS + GAP));
    const height = bottom + GRADIENTS + GAP + LIMITS + 4;
    this.image.setAttribute("viewBox", `0 0 ${width} ${height}`);
    this.image.setAttribute("height", height);
    this.places.show(this.plan.places, place => this.positionOf(place), name => [this.lines.get(name).begin_km, this.lines.get(name).end_km]);
    this.name();
    this.moved();
  }

  /** Called when the drawing was drawn anew. */
  moved() {}

  /** Scales of the plan, and of the profile below it. */
  fit(line) {
    const room = this.width - LEFT - RIGHT;
    const xs = this.plan.lines.flatMap(each => each.path.x), ys = this.plan.lines.flatMap(each => each.path.y);
    const [low, high] = [Math.min(...xs), Math.max(...xs)], top = Math.max(...ys);
    const margin = 0.02 * (high - low);
    this.x = value => LEFT + room * (value - low + margin) / (high - low + 2 * margin);
    this.y = value => TRACK + (top - value) * ROW;
    this.height = TRACK + (top - Math.min(...ys)) * ROW + BELOW + NAMES;
    const own = 0.02 * (line.end_km - line.begin_km);
    this.along = (each, km) => LEFT + room * (km - each.begin_km + own) / (each.end_km - each.begin_km + 2 * own);
  }

  at(line, km) {
    const { km: own, x, y } = line.path;
    let i = own.findIndex(each => each >= km);
    if (i < 1) i = i === 0 ? 1 : own.length - 1;
    const share = (km - own[i - 1]) / (own[i] - own[i - 1] || 1);
    return [this.x(x[i - 1] + share * (x[i] - x[i - 1])), this.y(y[i - 1] + share * (y[i] - y[i - 1]))];
  }

  track(line) {
    const d = (from, to) => {
      const kms = [from, ...line.path.km.filter(km => km > from && km < to), to];
      return kms.map((km, i) => `${i ? "L" : "M"}${this.at(line, km).map(each => each.toFixed(1)).join(" ")}`).join("");
    };
    const most = Math.max(...line.tracks.map(each => each[2]));
    const tracks = line.tracks.flatMap(([from, to, count]) => Array.from({ length: count }, (_, k) =>
      svg("path", { class: "track", d: d(from, to), transform: `translate(0 ${(k - (count - 1) / 2) * TRACK_GAP})` })));
    const name = !this.single && svg("text", { class: "line-name", x: this.at(line, line.end_km)[0], y: this.at(line, line.end_km)[1] + 18 + 2 * most, "text-anchor": "end" }, line.name);
    return [...tracks, name];
  }

  stretches() {
    return this.plan.stretches.flatMap(({ kind, line: name, ends_km: [from, to] }) => {
      const line = this.lines.get(name);
      if (!line) return [];
      const [[x1, y1], [x2, y2]] = [this.at(line, from), this.at(line, to)];
      return [svg("line", { class: `stretch ${kind.split(" ")[0]}`, x1, y1, x2, y2 }, svg("title", {}, `${kind}, km ${from} to ${to}`))];
    });
  }

  /** The high-voltage line beside a line, through its transformers and stations. */
  highVoltage() {
    const transformers = this.plan.places.filter(each => each.kind === "transformer");
    if (!transformers.length) return null;
    const line = this.lines.get(transformers[0].line);
    const stations = this.plan.places.filter(each => each.kind === "feeding" && each.line === line.name);
    const kms = [...transformers, ...stations].map(each => each.km);
    const [x1, y] = this.at(line, Math.min(...kms)), [x2] = this.at(line, Math.max(...kms));
    return svg("line", { class: "high-voltage", x1, x2, y1: y + BELOW, y2: y + BELOW });
  }

  positionOf(place) {
    const [x, y] = this.at(this.lines.get(place.line), place.km);
    return [x, place.kind === "station" || place.kind === "break" ? y : y + BELOW];
  }

  /** Kilometre of a line that is nearest to the pointer. */
  kmAt(event, name) {
    const box = this.image.getBoundingClientRect(), line = this.lines.get(name);
    const px = [event.clientX - box.left, event.clientY - box.top];
    let best = [Infinity, 0];
    const { km, x, y } = line.path;
    for (let i = 1; i < km.length; i += 1) {
      const a = [this.x(x[i - 1]), this.y(y[i - 1])], b = [this.x(x[i]), this.y(y[i])];
      const d = [b[0] - a[0], b[1] - a[1]], long = d[0] ** 2 + d[1] ** 2 || 1;
      const share = Math.max(0, Math.min(1, ((px[0] - a[0]) * d[0] + (px[1] - a[1]) * d[1]) / long));
      const off = (a[0] + share * d[0] - px[0]) ** 2 + (a[1] + share * d[1] - px[1]) ** 2;
      if (off < best[0]) best = [off, km[i - 1] + share * (km[i] - km[i - 1])];
    }
    return best[1];
  }

  /** Names of what stands there, those that have room. */
  name() {
    const taken = [];
    const rank = { feeding: 0, station: 1, storage: 2, post: 3 };
    const named = this.plan.places.filter(each => each.kind in rank).sort((one, other) => rank[one.kind] - rank[other.kind]);
    this.labels.replaceChildren(...named.flatMap(place => {
      const [x, y] = this.positionOf(place);
      const above = place.kind === "station";
      const lines = above ? [place.name] : [place.name, place.detail].filter(Boolean);
      const wide = 6.6 * Math.max(...lines.map(each => each.length)) + 8;
      const anchor = x - wide / 2 < 4 ? "start" : x + wide / 2 > this.width - 4 ? "end" : "middle";
      const left = anchor === "start" ? x - 7 : anchor === "end" ? x - wide + 7 : x - wide / 2;
      const box = [left, left + wide, above ? y - 26 : y + 8, above ? y - 8 : y + 36];
      if (taken.some(each => box[0] < each[1] && box[1] > each[0] && box[2] < each[3] && box[3] > each[2])) return [];
      taken.push(box);
      const from = anchor === "start" ? x - 7 : anchor === "end" ? x + 7 : x;
      return lines.map((text, k) => svg("text", { class: k ? "detail" : `name ${place.kind}`, x: from, y: above ? y - 12 : y + 22 + 14 * k, "text-anchor": anchor }, text));
    }));
  }
}
