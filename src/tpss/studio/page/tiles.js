// Key figures: the few that one looks at first, and all of them, with differences to the pinned baseline.

import { el, refill, shown, signed } from "./dom.js";

const FIRST = [
  ["lowest voltage", "Lowest voltage", +1], ["highest peak loading", "Highest loading", -1], ["trip time", "Trip time", -1],
  ["total energy", "Energy", -1], ["losses", "Losses", -1],
];
/** Figures by their words, how they are called here, and whether more is better. */

const WITHOUT_DIFFERENCE = /^(place|time) of/;

const byWords = figures => new Map(figures.map(([words, ...rest]) => [words, rest]));

function differenceOf(words, value, base, digits) {
  if (typeof value !== "number" || typeof base !== "number" || WITHOUT_DIFFERENCE.test(words)) return "";
  return signed(value - base, digits);
}

export class Tiles {
  constructor(place, tables) {
    this.place = place;
    this.all = el("tbody", {});
    this.heads = el("tr", {});
    this.stations = el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "Feeding stations" });
    tables.append(
      el("details", { class: "panel" }, el("summary", {}, el("h2", {}, "All key figures")),
        el("div", { class: "scroll", tabindex: "0", role: "region", "aria-label": "All key figures" },
          el("table", {}, el("thead", {}, this.heads), this.all))),
      el("details", { class: "panel", open: true }, el("summary", {}, el("h2", {}, "Feeding stations")), this.stations));
  }

  show(result, baseline) {
    const now = byWords(result.figures), base = byWords(baseline?.figures || []);
    const extra = this.lowestUseful(result.figures);
    this.place.replaceChildren(...[...FIRST, ...extra].filter(([words]) => now.has(words)).map(([words, title, better]) => {
      const [unit, value, digits] = now.get(words);
      const few = unit === "kV" || unit === "MWh" ? 2 : digits;
      const difference = differenceOf(words, value, base.get(words)?.[1], few);
      const good = difference && (difference[0] === "+") === (better > 0);
      return el("div", { class: "tile" }, el("p", { class: "tile-name" }, title),
        el("p", { class: "tile-value" }, shown(value, few), el("span", { class: "unit" }, ` ${unit}`)),
        el("p", { class: `tile-difference ${difference ? (good ? "good" : "bad") : ""}` },
          difference ? `${difference} ${unit}` : this.beside(words, now)));
    }));
    this.heads.replaceChildren(...["figure", "now", ...(baseline ? ["baseline", "difference"] : [])].map(each => el("th", { scope: "col" }, each)));
    this.all.replaceChildren(...result.figures.map(([words, unit, value, digits]) => el("tr", {},
      el("th", { scope: "row" }, unit ? `${words} [${unit}]` : words), this.cell(value, digits),
      baseline && this.cell(base.get(words)?.[1], digits),
      baseline && el("td", { class: "number" }, differenceOf(words, value, base.get(words)?.[1], digits)))));
    this.showStations(result.stations);
  }

  cell(value, digits) {
    return el("td", { class: typeof value === "number" ? "number" : "" }, shown(value, Number.isInteger(value) ? 0 : digits));
  }

  /** Where the lowest voltage is, and which station is loaded highest. */
  beside(words, now) {
    if (words === "lowest voltage") {
      const place = now.get("place of lowest voltage");
      return place ? (place[0] ? `at km ${shown(place[1], 1)}` : String(place[1])) : "";
    }
    return words === "highest peak loading" ? String(now.get("station with highest peak loading")?.[1] ?? "") : "";
  }

  lowestUseful(figures) {
    const zones = figures.filter(([words, , value]) => words.startsWith("mean useful voltage") && typeof value === "number");
    if (!zones.length) return [];
    const worst = zones.reduce((one, other) => other[2] < one[2] ? other : one);
    return [[worst[0], "Useful voltage", +1]];
  }

  showStations(table) {
    this.stations.replaceChildren(table ? el("table", {},
      el("thead", {}, el("tr", {}, table.headings.map((each, k) => el("th", { scope: "col" }, table.units[k] ? `${each} [${table.units[k]}]` : each)))),
      el("tbody", {}, table.rows.map(row => el("tr", {}, row.map((value, k) => k === 0 ? el("th", { scope: "row" }, String(value)) : this.cell(value, table.digits[k])))))) : "");
  }
}
