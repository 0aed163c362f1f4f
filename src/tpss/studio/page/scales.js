// Colours and scales that all drawings have in common.

import { colour } from "./dom.js";

export const LEFT = 58;
export const RIGHT = 18;
/** Space beside every plot, so that those over the same axis stand below each other. [px] */

/** Look of an axis; its numbers are written as everywhere else on the page: 12500, not 12,500. */
export const AXIS = { stroke: () => colour("--soft"), font: "12px system-ui, sans-serif", grid: { stroke: () => colour("--rule"), width: 1 },
  ticks: { show: false }, values: (_, ticks) => ticks.map(each => String(each).replace("-", "−")) };

export const DASHES = [[], [7, 4], [7, 3, 2, 3], [2, 3]];

const STOPS = [[0, [7, 5, 27]], [0.125, [41, 11, 85]], [0.25, [84, 15, 109]], [0.375, [122, 29, 109]], [0.5, [162, 43, 98]],
  [0.625, [199, 62, 76]], [0.75, [228, 90, 49]], [0.875, [247, 130, 18]], [1, [252, 174, 18]]];
const STEPS = 24;

function mixed(share, lift) {
  const k = Math.max(1, STOPS.findIndex(([at]) => at >= share));
  const [from, low] = STOPS[k - 1], [to, high] = STOPS[k];
  const part = (share - from) / (to - from || 1);
  const parts = low.map((each, i) => Math.round(lift + (1 - lift / 255) * (each + part * (high[i] - each))));
  return `rgb(${parts.join(",")})`;
}

let made = null;

/** Colours from a low value, dark, to a high one; lifted where the page itself is dark. */
export function ramp() {
  const dark = isDark();
  if (!made || made.dark !== dark)
    made = { dark, colours: Array.from({ length: STEPS }, (_, k) => mixed(k / (STEPS - 1), dark ? 70 : 0)) };
  return made.colours;
}

export function shadeOf(value, low, high) {
  const share = (value - low) / (high - low || 1);
  return Math.max(0, Math.min(STEPS - 1, Math.round(share * (STEPS - 1))));
}

export const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches;

export const curveColour = k => colour(`--curve-${k % 6}`);

/** Lowest and highest of some arrays, with a margin that is a share of their distance. */
export function spanOf(arrays, margin, values = []) {
  let low = Math.min(...values), high = Math.max(...values);
  for (const array of arrays) for (let i = 0; i < array.length; i += 1) {
    if (array[i] < low) low = array[i];
    if (array[i] > high) high = array[i];
  }
  if (!(low <= high)) return [0, 1];
  const room = margin * (high - low || Math.abs(high) || 1);
  return [low - room, high + room];
}
