// The page of a study: choose a case, and what the plot of two figures shows.
(() => {
  const { study } = JSON.parse(document.getElementById("report-data").textContent).run;
  const element = (id) => document.getElementById(id);
  const column = (key) => study.columns.find((each) => each.key === key);

  function shownValue({ values, levels }, row) {
    const value = values[row];
    if (value === null) return "–";
    return levels.length ? levels[value] : String(Number(value.toPrecision(5)));
  }

  // ---- one case

  function choose(number) {
    const row = study.cases.indexOf(number);
    element("case").value = number;
    element("case-command").textContent = `tpss sweep ${study.folder} --case ${number}`;
    const told = element("case-told");
    if (row < 0) {
      told.textContent = `Case ${number} has no figures here: it did not run, its audit failed, or it was left out.`;
      return;
    }
    const list = document.createElement("dl");
    list.className = "figures";
    for (const each of study.columns) {
      const item = document.createElement("div");
      const name = document.createElement("dt"), value = document.createElement("dd");
      name.textContent = each.label;
      value.textContent = shownValue(each, row);
      item.append(name, value);
      list.append(item);
    }
    const head = document.createElement("p");
    head.innerHTML = "<strong></strong>";
    head.firstChild.textContent = `Case ${number}: ${study.status[row]}`;
    told.replaceChildren(head, list);
  }

  const input = element("case");
  input.addEventListener("change", () => {
    const number = Math.round(Number(input.value));
    if (Number.isFinite(number) && input.value !== "") choose(number);
  });
  element("copy").addEventListener("click", async () => {
    const text = element("case-command").textContent;
    try {
      await navigator.clipboard.writeText(text);
      element("copy").textContent = "Copied";
    } catch {
      getSelection().selectAllChildren(element("case-command")); // a page from a file may not write
      element("copy").textContent = "Selected: press Ctrl+C";
    }
  });

  for (const id of ["parallel", "trade-offs"]) {
    const div = element(id);
    if (!div) continue;
    div.on("plotly_click", ({ points: [point] }) => {
      const number = /^case (\d+)/.exec(point.text || "");
      if (number) choose(Number(number[1]));
    });
  }

  // ---- two figures against each other

  const selects = ["across", "up", "shade"].map(element);
  if (!selects[0]) return;

  function show() {
    const [across, up, shade] = selects.map((select) => column(select.value));
    const rows = study.cases.map((_, row) => row)
      .filter((row) => across.values[row] !== null && up.values[row] !== null);
    const known = shade.values.filter((value) => value !== null);
    const label = (row) => [`case ${study.cases[row]}`,
      ...[across, up, shade].map((each) => `${each.label}: ${shownValue(each, row)}`)].join("<br>");
    Plotly.restyle("trade-offs", {
      x: [rows.map((row) => across.values[row])], y: [rows.map((row) => up.values[row])],
      text: [rows.map(label)], "marker.color": [rows.map((row) => shade.values[row])],
      "marker.cmin": Math.min(...known), "marker.cmax": Math.max(...known),
      "marker.colorbar.title.text": shade.label,
    }, [0]);
    Plotly.relayout("trade-offs", {
      "xaxis.title.text": across.label, "yaxis.title.text": up.label,
      "xaxis.autorange": true, "yaxis.autorange": true,
    });
  }
  for (const select of selects) select.addEventListener("change", show);
})();
