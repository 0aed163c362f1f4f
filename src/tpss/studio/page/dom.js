// Elements.  Texts of others become text nodes, never markup.

const there = children =>
  children.flat(3).filter(each => each !== null && each !== undefined && each !== false);

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) node.addEventListener(name.slice(2), value);
    else if (name === "value") node.value = value;
    else node.setAttribute(name, value === true ? "" : String(value));
  }
  node.append(...there(children));
  return node;
}

export const el = (tag, attributes, ...children) =>
  fill(document.createElement(tag), attributes, children);

export const svg = (tag, attributes, ...children) =>
  fill(document.createElementNS("http://www.w3.org/2000/svg", tag), attributes, children);

/** Put children in place of those of a node; what is null or false is left out. */
export const refill = (node, ...children) => node.replaceChildren(...there(children));

export const element = id => document.getElementById(id);

export const colour = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** A number with so many decimals; a dash where there is none. */
export function shown(value, digits = 2) {
  if (value === null || value === undefined) return "–";
  if (typeof value !== "number") return String(value);
  return Number.isInteger(value) && digits === 0 ? String(value) : value.toFixed(digits).replace("-", "−");
}

/** A difference with its sign; empty where it is too small to be seen. */
export function signed(value, digits) {
  const text = Math.abs(value).toFixed(digits);
  return Number(text) === 0 ? "" : `${value > 0 ? "+" : "−"}${text}`;
}

/** A number as one writes it into a file. */
export const written = value => typeof value === "number" ? String(Number(value.toPrecision(10))) : String(value);
