// Views of the result, of which one is shown: tabs that arrow keys move along.

import { el } from "./dom.js";

export class Tabs {
  /** @param tabs of {key, words, element, shown}: `shown` is called when a tab comes into view. */
  constructor(list, place, tabs) {
    this.tabs = tabs;
    this.buttons = tabs.map((tab, k) => el("button", { type: "button", role: "tab", id: `tab-${tab.key}`, "aria-controls": `panel-${tab.key}`,
      onclick: () => this.choose(k), onkeydown: event => this.byKey(event, k) }, tab.words));
    list.append(...this.buttons);
    this.panels = tabs.map(tab => el("div", { role: "tabpanel", id: `panel-${tab.key}`, "aria-labelledby": `tab-${tab.key}`, class: "tabpanel" }, tab.element));
    place.append(...this.panels);
    this.choose(0);
  }

  choose(chosen) {
    this.chosen = chosen;
    this.buttons.forEach((button, k) => {
      button.setAttribute("aria-selected", String(k === chosen));
      button.tabIndex = k === chosen ? 0 : -1;
      this.panels[k].hidden = k !== chosen;
    });
    this.tabs[chosen].shown?.();
  }

  get key() { return this.tabs[this.chosen].key; }

  byKey(event, k) {
    const move = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
    if (!move) return;
    event.preventDefault();
    const next = (k + move + this.tabs.length) % this.tabs.length;
    this.choose(next);
    this.buttons[next].focus();
  }
}
