// What was edited, to copy as options of the command line, as Python, or as lines of the file.

import { el, element } from "./dom.js";

const KINDS = [["options", "Command line"], ["python", "Python"], ["toml", "File"]];

export function showChanges(told, command) {
  const dialog = element("dialog");
  const text = { options: told.count ? `${command.replace("tpss studio", "tpss run")} ${told.options}` : "", python: told.python, toml: told.toml };
  const pre = el("pre", { tabindex: "0", "aria-label": "Changes as text" });
  const status = el("span", { role: "status" });
  const choose = key => {
    pre.textContent = told.count ? text[key] : "Nothing was changed.";
    buttons.forEach((button, k) => button.setAttribute("aria-pressed", String(KINDS[k][0] === key)));
    status.textContent = "";
  };
  const buttons = KINDS.map(([key, words]) => el("button", { type: "button", onclick: () => choose(key) }, words));
  const copy = async () => {
    await navigator.clipboard.writeText(pre.textContent);
    status.textContent = "Copied.";
  };
  dialog.replaceChildren(
    el("h2", { id: "dialog-title" }, `${told.count} change${told.count === 1 ? "" : "s"}`),
    el("div", { class: "choices", role: "group", "aria-label": "Written as" }, buttons), pre,
    el("div", { class: "choices end" }, status, el("button", { type: "button", onclick: copy, disabled: !told.count }, "Copy"),
      el("button", { type: "button", class: "main", onclick: () => dialog.close() }, "Close")));
  choose("options");
  dialog.showModal();
}
