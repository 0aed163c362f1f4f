// Gradients and speed limits of a line over its kilometres, as steps.

import { shown, svg } from "./dom.js";

export const GRADIENTS = 44, LIMITS = 38;
/** Heights of both. [px] */

/** Steps of a profile from beginning to end: [from, to, value]. */
function stepsOf(rows, begin, end) {
  return rows.map(([from, value], i) => [Math.max(from, begin), i + 1 < rows.length ? rows[i + 1][0] : end, value])
    .filter(([from, to]) => to > from);
}

export function gradients(line, x, top) {
  const steps = stepsOf(line.gradients, line.begin_km, line.end_km);
  const most = Math.max(1, ...steps.map(each => Math.abs(each[2])));
  const middle = top + GRADIENTS / 2, scale = (GRADIENTS / 2 - 4) / most;
  const area = steps.map(([from, to, value]) => `H${x(from).toFixed(1)}V${(middle - value * scale).toFixed(1)}H${x(to).toFixed(1)}`).join("");
  return svg("g", { class: "gradients" }, svg("title", {}, `Gradients, ${shown(-most, 1)} to ${shown(most, 1)} ‰`),
    svg("path", { class: "area", d: `M${x(line.begin_km)} ${middle}${area}V${middle}z` }),
    svg("line", { class: "zero", x1: x(line.begin_km), x2: x(line.end_km), y1: middle, y2: middle }),
    svg("text", { class: "tick", x: x(line.begin_km) - 6, y: top + 10, "text-anchor": "end" }, `+${Math.round(most)} ‰`),
    svg("text", { class: "tick", x: x(line.begin_km) - 6, y: top + GRADIENTS - 2, "text-anchor": "end" }, `−${Math.round(most)} ‰`));
}

export function limits(line, x, top) {
  const steps = stepsOf(line.limits, line.begin_km, line.end_km);
  const most = Math.max(...steps.map(each => each[2]));
  const y = value => top + LIMITS - 4 - (LIMITS - 16) * value / most;
  const path = steps.map(([from, to, value], i) => `${i ? "V" : `M${x(from).toFixed(1)} `}${y(value).toFixed(1)}H${x(to).toFixed(1)}`).join("");
  let free = -Infinity;
  const labels = steps.flatMap(([from, , value]) => {
    if (x(from) < free) return [];
    free = x(from) + 44;
    return [svg("text", { class: "tick", x: x(from) + 3, y: y(value) - 3 }, shown(value, 0))];
  });
  return svg("g", { class: "limits" }, svg("title", {}, "Speed limits [km/h]"), svg("path", { d: path }), labels,
    svg("text", { class: "tick", x: x(line.begin_km) - 6, y: top + LIMITS - 2, "text-anchor": "end" }, "km/h"));
}
