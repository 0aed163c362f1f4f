// The page: opens the scenario, hands edits to the server, and shows what comes of them.

import { drawingOf } from "./arrays.js";
import { Charts } from "./charts.js";
import { showChanges } from "./changes.js";
import { Schema } from "./documents.js";
import { el, element } from "./dom.js";
import { Drafts } from "./drafts.js";
import { Form } from "./form.js";
import { History } from "./history.js";
import { Moving } from "./moving.js";
import { Outages, toggled } from "./outages.js";
import { Live } from "./live.js";
import { Plan } from "./plan.js";
import { Lost, ask, isReady } from "./server.js";
import { Reports } from "./reports.js";
import { Research } from "./research.js";
import { Tabs } from "./tabs.js";
import { Tiles } from "./tiles.js";
import { Tray } from "./tray.js";
import { Verdicts } from "./verdicts.js";
import { WhatIf } from "./whatif.js";

const WARM_MS = 400;

const page = { opened: null, answer: null, baseline: null, charts: null };

const history = new History(() => { live.request(); drafts.later(); showActions(); settle(); });
const drafts = new Drafts(history, overtaken, failed, settle);
const live = new Live({ pairs: () => history.pairs(), charts: () => [...page.charts.names, ...(moving.on ? ["moving"] : [])], isSound: () => page.answer?.findings.length === 0, answered, checked, failed, busy, settle });
const verdicts = new Verdicts(element("verdicts"));
const drawings = el("div", { id: "drawings" }), tables = el("div", { id: "tables" });
const tiles = new Tiles(element("tiles"), tables);
const plan = new Plan({
  move: (path, km, label) => history.push(label, [[path, km]], path),
  toggle: place => history.push(`${place.name} out of service, or back`, toggled(page.document, place)),
});
const moving = new Moving(plan, () => live.request());
const tool = {
  page: live.page, pairs: () => history.pairs(), failed,
  push: (label, pairs) => pairs.length && history.push(label, pairs),
  replace: (label, pairs) => history.replace(label, pairs),
};
const tools = { tray: new Tray(tool), outages: new Outages(tool), reports: new Reports(tool) };
let form = null;

/** Say in the page whether all that was edited is shown and kept. */
function settle() {
  document.body.dataset.answered = String(!live.isBusy);
  document.body.dataset.settled = String(!live.isBusy && !drafts.isBehind);
}

// ---- what the server tells

function answered(answer) {
  page.answer = answer;
  document.body.classList.toggle("at-fault", answer.findings.length > 0);
  form.show(answer.document || page.document, answer.effective, answer.findings);
  page.document = answer.document || page.document;
  tools.whatIf.show(page.document, answer.effective);
  if (answer.plan) plan.show(answer.plan);
  if (answer.result) show(answer.result);
  document.body.dataset.number = answer.number;
  performance.mark("shown", { detail: answer.number });
}

function show(result) {
  result.drawings = Object.fromEntries(Object.entries(result.charts).map(([name, told]) => [name, drawingOf(told)]));
  page.result = result;
  if (!page.baseline) pin();
  verdicts.show(result);
  moving.show(result.moving);
  compare();
}

/** Show the result against the baseline; one that is the baseline has no ghosts. */
function compare() {
  const { result, baseline } = page;
  const other = baseline === result ? null : baseline;
  tiles.show(result, other);
  page.charts.show(result.offered, result.drawings, other?.drawings);
}

function checked(told) { verdicts.check(told); }

function failed(error) {
  if (error instanceof Lost) {
    notice("The server does not answer. Edits up to the last result are kept; start it again, and open the address that it prints:", [page.opened?.command || "tpss studio"]);
    document.body.classList.add("lost");
    element("edit").inert = true;
    return;
  }
  notice(error.message);
}

function busy(is) {
  element("state").textContent = is ? "Computing …" : "";
  document.body.classList.toggle("busy", is);
}

/** @param actions texts of commands, or pairs of words and a function. */
function notice(words, actions = []) {
  const place = element("notice");
  place.hidden = !words;
  place.replaceChildren(words, ...actions.map(each => typeof each === "string" ? el("code", {}, each)
    : el("button", { type: "button", onclick: () => { notice(""); each[1](); } }, each[0])));
}

function overtaken() {
  notice("Another page has edited this file: what you do here is not kept.", [
    ["Take over its edits", async () => { const draft = await ask("read-draft"); startFrom(draft); live.request(); }],
    ["Keep mine", async () => { const draft = await ask("read-draft"); drafts.start(draft, page.digest); drafts.later(); }],
  ]);
}

// ---- what one does

function pin() {
  page.baseline = page.result;
  if (page.pinned) page.pinned.textContent = history.edits.length ? `Baseline: after ${history.edits.length} edits` : "Baseline: the file as it is";
}

function showActions() {
  element("undo").disabled = !history.edits.length;
  element("redo").disabled = !history.undone.length;
  element("undo").title = history.edits.at(-1)?.label || "";
  element("redo").title = history.undone.at(-1)?.label || "";
  element("save").disabled = !history.edits.length;
  element("changes").textContent = history.edits.length ? `Changes (${history.edits.length})` : "Changes";
}

async function trying(work) {
  try { await work(); } catch (error) { failed(error); }
}

async function save() {
  const told = await ask("save", { edits: history.pairs(), digest: page.digest });
  page.digest = told.digest;
  history.start([], []);
  drafts.digest = told.digest;
  drafts.later();
  showActions();
  live.request();
  element("state").textContent = `Saved ${told.name}.`;
}

function startFrom(draft) {
  history.start(draft.edits, draft.undone);
  drafts.start(draft, page.digest);
  showActions();
}

async function readPasted(text, columns, path) {
  try {
    return (await ask("read-rows", { text, columns: columns.map(each => [each.key, each.kind === "number"]), path })).rows;
  } catch (error) {
    failed(error);
    return null;
  }
}

// ---- the page as it is built

function buildCharts() {
  drawings.append(plan.element);
  page.charts = new Charts(drawings, page.opened.charts, () => live.request());
  page.pinned = el("span", {}, "");
  const button = el("button", { type: "button", class: "quiet", id: "pin", onclick: () => { pin(); compare(); } }, "Pin as baseline");
  element("verdicts").after(el("div", { class: "baseline" }, page.pinned, button));
}

function buildTabs(schemas) {
  tools.whatIf = new WhatIf(tool, schemas);
  const research = new Research(tool, page.opened.explained.map(name => [name, page.opened.charts[name].title]));
  new Tabs(element("tabs"), element("panels"), [
    { key: "curves", words: "Curves", element: [drawings, tables] },
    { key: "what-if", words: "What if", element: tools.whatIf.element },
    { key: "variants", words: "Variants", element: tools.tray.element, shown: () => tools.tray.run() },
    { key: "outages", words: "Outages", element: tools.outages.element },
    { key: "research", words: "Research", element: research.element, shown: () => research.shown() },
  ]);
}

function listen() {
  element("report").addEventListener("click", () => tools.reports.open());
  element("undo").addEventListener("click", () => history.undo());
  element("redo").addEventListener("click", () => history.redo());
  element("changes").addEventListener("click", () => trying(async () =>
    showChanges(await ask("changes", { edits: history.pairs() }), page.opened.command)));
  element("save").addEventListener("click", () => trying(save));
  addEventListener("keydown", event => {
    if (!(event.ctrlKey || event.metaKey)) return;
    const key = event.key.toLowerCase();
    const action = key === "z" ? (event.shiftKey ? "redo" : "undo") : { y: "redo", s: "save" }[key];
    if (!action) return;
    event.preventDefault();
    element(action).click();
  });
  for (const [id, other, view] of [["to-result", "to-form", "result"], ["to-form", "to-result", "form"]])
    element(id).addEventListener("click", () => {
      document.body.dataset.view = view;
      element(id).setAttribute("aria-pressed", "true");
      element(other).setAttribute("aria-pressed", "false");
    });
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => page.charts.draw());
}

async function warm() {
  while (!(await isReady())) {
    element("state").textContent = "Compiling the numerical kernels; this takes up to a minute, once.";
    await new Promise(done => setTimeout(done, WARM_MS));
  }
  element("state").textContent = "";
}

async function open() {
  const opened = await ask("opened");
  Object.assign(page, { opened, digest: opened.digest, document: opened.document });
  element("name").textContent = opened.document.name || opened.name;
  element("file").textContent = opened.name;
  document.title = `${opened.name} – TPSS studio`;
  const schemas = new Schema(opened.schema, opened.labels);
  form = new Form(element("edit"), schemas, (...edit) => history.push(...edit), readPasted);
  form.show(opened.document, undefined, []);
  buildCharts();
  buildTabs(schemas);
  listen();
  if (opened.draft.digest === opened.digest || !opened.draft.edits.length) startFrom(opened.draft);
  else {
    drafts.start(opened.draft, opened.digest);
    notice("There is a draft of edits to another state of this file.", [["Use its edits", () => { startFrom(opened.draft); live.request(); }], ["Leave it", () => drafts.later()]]);
  }
  document.body.dataset.view = "result";
  await warm();
  live.request();
}

trying(open);
