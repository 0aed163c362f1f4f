// One value of the scenario as a field, with its findings beside it.

import { el, written } from "./dom.js";

let counted = 0;

/** What a text that was typed stands for: a number, with a point or a comma, or else the text itself. */
export function numberOf(text) {
  const plain = text.trim().replace(/\s/g, "").replace("−", "-").replace(",", ".");
  return plain !== "" && Number.isFinite(Number(plain)) ? Number(plain) : text.trim();
}

/** A number moved by steps of its last digit. */
function stepped(text, steps) {
  const value = numberOf(text);
  if (typeof value !== "number") return null;
  const digits = (text.split(/[.,]/)[1] || "").length;
  return Number((value + steps * 10 ** -digits).toFixed(digits));
}

function inputOf(node, edit) {
  const id = node.id;
  const send = value => edit(node.path, value, node.words);
  if (node.kind === "flag")
    return el("input", { type: "checkbox", id, onchange: event => send(event.target.checked) });
  if (node.kind === "choice" && !node.open)
    return el("select", { id, onchange: event => send(event.target.value === "" ? null : event.target.value) },
      !node.required && el("option", { value: "" }, "–"),
      node.choices.map(each => el("option", { value: each }, each)));
  const isNumber = node.kind === "number";
  const read = text => text.trim() === "" ? null : isNumber ? numberOf(text) : text;
  const input = el("input", {
    type: "text", id, autocomplete: "off", spellcheck: "false", inputmode: isNumber ? "decimal" : null,
    list: node.choices.length ? `${id}-names` : null, class: isNumber ? "number" : "",
    oninput: event => send(read(event.target.value)),
    onkeydown: event => {
      const steps = { ArrowUp: 1, ArrowDown: -1 }[event.key];
      if (!isNumber || !steps) return;
      const value = stepped(event.target.value || event.target.placeholder, event.shiftKey ? 10 * steps : steps);
      if (value === null) return;
      event.preventDefault();
      event.target.value = written(value);
      send(value);
    },
  });
  if (!node.choices.length) return input;
  return [input, el("datalist", { id: `${id}-names` }, node.choices.map(each => el("option", { value: each })))];
}

/** A field: its label, input, unit, and place for findings; `show` brings it up to date. */
export class Field {
  constructor(node, edit) {
    this.node = { ...node, id: `field-${(counted += 1)}` };
    const input = inputOf(this.node, edit);
    this.input = [input].flat()[0];
    this.finding = el("p", { class: "finding", id: `${this.node.id}-finding`, hidden: true });
    this.unit = el("span", { class: "unit", "aria-hidden": "true" }, node.unit);
    this.label = el("label", { for: this.node.id, title: node.hint }, node.words,
      node.unit && el("span", { class: "hidden" }, ` in ${node.unit}`));
    this.element = el("div", { class: `field ${node.kind}` }, this.label,
      el("span", { class: "value" }, input, this.unit), this.finding);
  }

  show(value, effective, findings) {
    const { kind, required } = this.node, input = this.input;
    const given = value !== undefined && value !== null;
    this.element.classList.toggle("given", given);
    if (kind === "flag") input.checked = given ? value === true : effective === true;
    else if (document.activeElement !== input || this.isBehind(value)) {
      const text = given ? written(value) : "";
      if (input.value !== text) input.value = text;
      if (kind === "choice" && !this.node.open && !given && required) input.value = String(effective ?? "");
    }
    if (kind !== "flag" && input.placeholder !== undefined && typeof effective !== "object")
      input.placeholder = effective === undefined || effective === null ? "" : written(effective);
    this.finding.textContent = findings.map(each => each.words).join("; ");
    this.finding.hidden = findings.length === 0;
    if (findings.length) {
      input.setAttribute("aria-invalid", "true");
      input.setAttribute("aria-describedby", this.finding.id);
    } else {
      input.removeAttribute("aria-invalid");
      input.removeAttribute("aria-describedby");
    }
  }

  /** Whether the input shows another value than the document has, as after an undo. */
  isBehind(value) {
    const typed = this.input.value.trim();
    if (this.node.kind !== "number") return typed !== String(value ?? "");
    return numberOf(typed) !== (value ?? "");
  }
}
