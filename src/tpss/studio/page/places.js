// What stands at a place of a line, to be moved by dragging or by keys: each is a slider along its line.

import { shown, svg } from "./dom.js";

const STEP_KM = 0.1, LARGE_KM = 1, PAGE_KM = 5, FINE_KM = 0.01;

const SYMBOLS = {
  station: () => [svg("circle", { r: 5, class: "symbol-station" })],
  feeding: () => [svg("rect", { x: -7, y: -7, width: 14, height: 14, class: "symbol-feeding" }), svg("path", { d: "M1.5-5-3.5 1.5h3l-1 4 5-6.5h-3z", class: "bolt" })],
  transformer: () => [svg("circle", { cy: -3, r: 4.5, class: "symbol-transformer" }), svg("circle", { cy: 3, r: 4.5, class: "symbol-transformer" })],
  post: () => [svg("path", { d: "M0-6 6 0 0 6-6 0z", class: "symbol-feeding" })],
  break: () => [svg("path", { d: "M-5-5 5 5M5-5-5 5", class: "symbol-break" })],
  storage: () => [svg("rect", { x: -7, y: -5, width: 14, height: 10, class: "symbol-storage" })],
};

const OUTAGES = ["feeding", "transformer"];
/** Kinds that may be taken out of service here. */

const WORDS = { station: "Station", feeding: "Feeding station", transformer: "Transformer", post: "Post", break: "Section break", storage: "Store" };

const rounded = (km, step) => Number((Math.round(km / step) * step).toFixed(3));

export class Places {
  /** @param of {move, toggle}: move (path, km, label) edits a place, toggle (place) takes it out of service or back; toKm (event, line): kilometre under the pointer. */
  constructor(layer, of, toKm) {
    Object.assign(this, { layer, ...of, toKm });
    this.handles = new Map();
  }

  show(places, positionOf, ends) {
    const seen = new Set();
    for (const place of places) {
      const key = place.path || `${place.kind} ${place.line} ${place.name}`;
      seen.add(key);
      let handle = this.handles.get(key);
      if (!handle || handle.kind !== place.kind || handle.movable !== !!place.path) {
        handle?.element.remove();
        handle = this.handle(place, key);
        this.handles.set(key, handle);
        this.layer.append(handle.element);
      }
      handle.place = place;
      handle.ends = ends(place.line);
      this.bringUpToDate(handle, positionOf(place));
    }
    for (const [key, handle] of this.handles) if (!seen.has(key)) { handle.element.remove(); this.handles.delete(key); }
  }

  handle(place, key) {
    const movable = !!place.path;
    const title = svg("title", {});
    const element = svg("g", { class: `place ${place.kind}`, ...(movable ? { tabindex: 0, role: "slider", "aria-orientation": "horizontal" } : { role: "img" }) },
      title, svg("rect", { x: -13, y: -13, width: 26, height: 26, class: "grip" }), SYMBOLS[place.kind]());
    const handle = { element, title, kind: place.kind, movable, key, place };
    if (movable) {
      element.addEventListener("pointerdown", event => this.grab(event, handle));
      element.addEventListener("keydown", event => this.byKey(event, handle));
    }
    if (OUTAGES.includes(place.kind)) element.addEventListener("dblclick", () => this.toggle(handle.place));
    return handle;
  }

  bringUpToDate(handle, [x, y]) {
    const { place, element, ends } = handle;
    const name = place.kind === "transformer" ? "" : ` ${place.name}`;
    const words = `${WORDS[place.kind]}${name}${place.detail ? `, ${place.detail}` : ""}${place.out ? ", out of service" : ""}`;
    element.classList.toggle("out", place.out === true);
    element.setAttribute("transform", `translate(${x} ${y})`);
    element.setAttribute("aria-label", handle.movable ? words : `${words} at km ${shown(place.km, 1)}`);
    handle.title.textContent = `${words}, km ${shown(place.km, 2)}${handle.movable ? ": drag it, or use the arrow keys" : ""}${OUTAGES.includes(place.kind) ? "; double-click, or press o, to take it out of service or back" : ""}`;
    if (!handle.movable) return;
    element.setAttribute("aria-valuemin", ends[0]);
    element.setAttribute("aria-valuemax", ends[1]);
    element.setAttribute("aria-valuenow", place.km);
    element.setAttribute("aria-valuetext", `km ${shown(place.km, 2)}`);
  }

  put(handle, km) {
    const within = Math.min(handle.ends[1], Math.max(handle.ends[0], km));
    if (within === handle.place.km) return;
    handle.place = { ...handle.place, km: within };
    this.move(handle.place.path, within, `${handle.place.name} to km ${within}`);
  }

  byKey(event, handle) {
    if (event.key === "o" && OUTAGES.includes(handle.kind)) {
      event.preventDefault();
      this.toggle(handle.place);
      return;
    }
    const step = event.shiftKey ? LARGE_KM : event.altKey ? FINE_KM : STEP_KM;
    const moves = { ArrowLeft: -step, ArrowRight: step, ArrowDown: -step, ArrowUp: step, PageDown: -PAGE_KM, PageUp: PAGE_KM };
    if (!(event.key in moves)) return;
    event.preventDefault();
    this.put(handle, rounded(handle.place.km + moves[event.key], event.altKey ? FINE_KM : STEP_KM));
  }

  grab(event, handle) {
    event.preventDefault();
    handle.element.focus();
    handle.element.setPointerCapture(event.pointerId);
    handle.element.classList.add("held");
    const drag = moved => this.put(handle, rounded(this.toKm(moved, handle.place.line), moved.altKey ? FINE_KM : STEP_KM));
    const drop = () => {
      handle.element.classList.remove("held");
      handle.element.removeEventListener("pointermove", drag);
      handle.element.removeEventListener("pointerup", drop);
      handle.element.removeEventListener("pointercancel", drop);
    };
    handle.element.addEventListener("pointermove", drag);
    handle.element.addEventListener("pointerup", drop);
    handle.element.addEventListener("pointercancel", drop);
  }
}
