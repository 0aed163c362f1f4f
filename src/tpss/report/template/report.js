"use strict";
(() => {
  const { plots, run } = JSON.parse(document.getElementById("report-data").textContent);
  const element = (id) => document.getElementById(id);
  const divs = [...document.querySelectorAll(".plot")];
  const touched = matchMedia("(pointer: coarse)").matches;
  const CONFIG = {
    responsive: true,
    displaylogo: false,
    displayModeBar: touched ? false : "hover",
    // Named one by one: among plotly's own there is one that sends the figure to its maker's cloud.
    modeBarButtons: [["toImage"], ["zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"]],
  };
  const PRINTED = { width: 680, height: 370, tall: 480 }; // two plots a page, one of three panels
  const RED = "#D55E00";

  // ---- plots, and a cursor of time in all that are drawn over time

  const cursors = new Map(); // plot -> number of its cursor among the shapes
  const heights = new Map(); // plot -> its height on the screen

  function draw(div) {
    const { data, layout } = plots[div.id];
    if (touched) layout.dragmode = false; // a finger scrolls the page
    layout.shapes = layout.shapes || [];
    cursors.set(div, layout.shapes.length);
    heights.set(div, layout.height);
    layout.shapes.push({
      type: "line", xref: "x", yref: "paper", x0: 0, x1: 0, y0: 0, y1: 1,
      line: { color: "#000000", width: 1.5, dash: "dot" }, visible: false,
    });
    const skipped = div.id === "graph"; // black paths and cursor over the map of voltages
    colours.set(div, {
      layout: coloursIn(skipped ? { ...layout, shapes: [] } : layout, "", []),
      traces: data.map(({ line, marker }) => (skipped ? [] : coloursIn({ line, marker }, "", []))),
    });
    return Plotly.newPlot(div, data, layout, CONFIG).then(() => {
      div.classList.add("drawn");
      div.on("plotly_hover", (event) => follow(div, event.points[0].x));
    });
  }

  function follow(div, x) {
    const minutes = div.layout.meta === "time" ? x : div.id === "journey" ? timeAt(x) : null;
    if (minutes !== null) askFor(minutes);
  }

  function moveCursor(div, x) {
    const shape = `shapes[${cursors.get(div)}]`;
    const change = { [`${shape}.visible`]: x !== null };
    if (x !== null) Object.assign(change, { [`${shape}.x0`]: x, [`${shape}.x1`]: x });
    Plotly.relayout(div, change);
  }

  let wanted = null;
  function askFor(minutes) {
    if (wanted === null) requestAnimationFrame(() => { const m = wanted; wanted = null; setTime(m); });
    wanted = minutes;
  }

  function setTime(minutes) {
    for (const div of divs) if (div.layout.meta === "time") moveCursor(div, minutes);
    if (!slider) return;
    const step = Math.max(0, Math.min(+slider.max, Math.floor(minutes / run.step_min + 1e-6)));
    slider.value = step;
    showMoment(step);
  }

  // ---- the line at a moment

  const slider = element("time");

  // Number of the last sample at or before a step; a train has one for its first and its last step.
  function sampleAt(train, step) {
    let low = 0, high = train.step.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (train.step[middle] <= step) low = middle; else high = middle - 1;
    }
    return low;
  }

  function trainAt(train, step) {
    if (step < train.step[0] || step > train.step[train.step.length - 1]) return null;
    const [km, kmh] = [train.km, train.kmh].map((values) => between(train, values, step));
    return { name: train.name, km, kmh, kv: train.kv[sampleAt(train, step)] };
  }

  // A value of a train at a step, between its samples.
  function between(train, values, step) {
    const k = sampleAt(train, step), next = Math.min(k + 1, train.step.length - 1);
    const gap = train.step[next] - train.step[k];
    return values[k] + (gap ? (step - train.step[k]) / gap : 0) * (values[next] - values[k]);
  }

  const shown = (colour) => (isDark && DARK[colour]) || colour;

  // Trains of a run at a time: what its traces show, and what is said of them.
  function momentOf(each, minutes, single, colour, symbol) {
    const step = Math.floor(minutes / each.step_min + 1e-6);
    const there = each.trains.map((train) => trainAt(train, step)).filter((t) => t && t.kv !== null);
    const beyond = there.map((t) => t.kv < each.low_kv || t.kv > each.high_kv);
    const label = (t) =>
      `${t.name}<br>${t.km.toFixed(2)} km, ${t.kmh.toFixed(1)} km/h<br>${t.kv.toFixed(2)} kV`;
    const everywhere = each.network ? onNetwork(each.network, step) : there;
    const lowest = everywhere.reduce((a, b) => (a && a.kv <= b.kv ? a : b), null);
    const count = everywhere.length, where = each.network ? "network" : "line";
    const said = !lowest ? `No train is on the ${where}.` :
      `${count} train${count > 1 ? "s" : ""} on the ${where}; lowest voltage ` +
      `${lowest.kv.toFixed(2)} kV, ${lowest.name} at ${lowest.at || `${lowest.km.toFixed(1)} km`}.`;
    return {
      x: there.map((t) => t.km), y: there.map((t) => t.kv), text: there.map(label),
      symbol: beyond.map((b) => (b ? "triangle-down" : symbol)),
      color: beyond.map((b) => (b && single ? RED : colour)),
      said: single ? said : `${each.label}: ${said}`,
    };
  }

  // The last traces of the plot hold the trains, one per run; plotly changes what they say.
  const traces = slider ? plots[run.plot].data.length - run.runs.length : 0;
  const marks = slider ? plots[run.plot].data.slice(traces).map(({ marker }) => ({ ...marker })) : [];

  // Where a kilometre of a line lies in the plan; the points of its path rise.
  function placeOf({ km, x, y }, at) {
    let k = km.findIndex((there) => there >= at);
    k = Math.max(1, k < 0 ? km.length - 1 : k);
    const part = (at - km[k - 1]) / (km[k] - km[k - 1]);
    return [x[k - 1] + part * (x[k] - x[k - 1]), y[k - 1] + part * (y[k] - y[k - 1])];
  }

  // Between two lines a train is at the end of the first: both steps of the change are samples.
  function onNetwork({ lines, trains }, step) {
    return trains.map((train) => {
      const now = trainAt(train, step);
      if (!now || now.kv === null) return null;
      const k = sampleAt(train, step), line = lines[train.line[k]];
      const stays = train.line[k] === train.line[Math.min(k + 1, train.line.length - 1)];
      const km = stays ? now.km : train.km[k];
      return { ...now, km, line, aside: train.aside[k], at: `${line.name} km ${km.toFixed(1)}` };
    }).filter((now) => now);
  }

  function showNetwork(step) {
    const there = onNetwork(run.runs[0].network, step);
    const places = there.map(({ line, km, aside }) => {
      const [x, y] = placeOf(line, km);
      return [x, y + aside];
    });
    const label = ({ name, line, km, kmh, kv }) =>
      `${name}<br>${line.name} km ${km.toFixed(2)}, ${kmh.toFixed(1)} km/h<br>${kv.toFixed(2)} kV`;
    Plotly.restyle("network", {
      x: [places.map(([x]) => x)], y: [places.map(([, y]) => y)], text: [there.map(label)],
      "marker.color": [there.map(({ kv }) => kv)],
    }, [plots.network.data.length - 1]);
  }

  // What the clock shows at a minute, in brackets; nothing where there is none.
  function clockAt(minutes) {
    if (run.start_s === null) return "";
    const seconds = Math.round(run.start_s + 60 * minutes);
    const parts = [seconds / 3600, (seconds / 60) % 60, seconds % 60];
    return ` (${parts.map((part) => String(Math.floor(part)).padStart(2, "0")).join(":")})`;
  }

  function showMoment(step) {
    const minutes = step * run.step_min, single = run.runs.length === 1;
    const moments = run.runs.map((each, k) =>
      momentOf(each, minutes, single, shown(marks[k].color), marks[k].symbol));
    const all = (name) => moments.map((moment) => moment[name]);
    Plotly.restyle(run.plot, {
      x: all("x"), y: all("y"), text: all("text"),
      "marker.symbol": all("symbol"), "marker.color": all("color"),
    }, moments.map((_, k) => traces + k));
    if (plots.network) showNetwork(step);
    const text = `${minutes.toFixed(2)} min${clockAt(minutes)}`;
    element("now").textContent = text;
    slider.setAttribute("aria-valuetext", text);
    element("state").replaceChildren(...moments.map((moment) => {
      const line = document.createElement("p");
      line.textContent = moment.said;
      return line;
    }));
    const chosen = chosenTrain();
    if (chosen) {
      const now = trainAt(chosen, step);
      const place = now && (chosen.way ? between(chosen, chosen.way, step) : now.km);
      const x = element("against").value === "time" ? minutes : place;
      moveCursor(element("journey"), now ? x : null);
    }
  }

  let playing = 0;
  function play() {
    const button = element("play");
    if (playing) { clearInterval(playing); playing = 0; }
    else {
      if (+slider.value >= +slider.max) setTime(0);
      const stride = Math.max(1, Math.round(run.steps / 400)); // a run takes half a minute at most
      playing = setInterval(() => {
        if (+slider.value >= +slider.max) return play();
        setTime((+slider.value + stride) * run.step_min);
      }, 80);
    }
    button.textContent = playing ? "❚❚ Pause" : "▶ Play";
    button.setAttribute("aria-pressed", String(Boolean(playing)));
  }

  // ---- dark pages

  // Light colours of plots by their dark ones.  The map of voltages has a scale of its own.
  const DARK = {
    "#FFFFFF": "#15181D", "#1a1a1a": "#E6E6E6", "#DDDDDD": "#33383F", "#666666": "#9AA0A8",
    "#999999": "#6B7178", "#444444": "#C0C4CA", "#000000": "#E6E6E6", "#0072B2": "#4BA3DB",
  };

  // Every colour of a figure that has a dark one, as the path by which plotly changes it.
  function coloursIn(part, path, found) {
    for (const [key, value] of Object.entries(part || {})) {
      const place = Array.isArray(part) ? `${path}[${key}]` : path ? `${path}.${key}` : key;
      if (typeof value === "string" && DARK[value]) found.push([place, value]);
      else if (value && typeof value === "object" && !ArrayBuffer.isView(value))
        coloursIn(value, place, found);
    }
    return found;
  }

  const colours = new Map(); // plot -> colours of its layout, and of each trace
  let isDark = false;

  function paint(dark) {
    if (dark === isDark) return;
    isDark = dark;
    const shade = (pairs) =>
      Object.fromEntries(pairs.map(([path, light]) => [path, dark ? DARK[light] : light]));
    for (const div of divs) {
      const { layout, traces: each } = colours.get(div);
      each.forEach((pairs, k) => { if (pairs.length) Plotly.restyle(div, shade(pairs), [k]); });
      Plotly.relayout(div, shade(layout));
    }
    if (slider) showMoment(+slider.value);
  }

  // ---- the journey of a train

  const trainsOf = (each) => (each.network || each).trains; // all trains that can be chosen

  // The chosen train of a run; with no name, its studied one.
  function trainOf(each, name) {
    return trainsOf(each).find((train) => train.name === (name || each.chosen));
  }

  // Of a single run.
  function chosenTrain() {
    const select = element("train");
    return select && run.runs.length === 1 ? trainOf(run.runs[0], select.value) : null;
  }

  // -1 of a train that runs towards falling kilometres, which meets gradients with the other sign.
  function signOf(train) {
    return train.km[train.km.length - 1] < train.km[0] ? -1 : 1;
  }

  function timeAt(km) {
    const train = slider && chosenTrain();
    if (!train) return null;
    const places = train.way || train.km, sign = train.way ? 1 : signOf(train);
    const k = places.findIndex((there) => sign * there >= sign * km - 1e-3);
    return k < 0 ? null : train.step[k] * run.step_min;
  }

  // The gradient holds from its place to the next one's; before the first, the first.
  function gradientAt({ gradients: profile }, km) {
    return profile[Math.max(0, profile.findLastIndex(([from]) => from <= km))][1];
  }

  // Over the way since it began, of a train of a network, or over the line's kilometres.
  function journeyOf(each, name, against) {
    const train = trainOf(each, name);
    const gradient = train.permille || train.km.map((km) => signOf(train) * gradientAt(each, km));
    return {
      x: against === "time" ? train.step.map((k) => k * each.step_min) : train.way || train.km,
      y: [train.kmh, train.kv, gradient],
      name: run.runs.length === 1 ? train.name : `${each.label}: ${train.name}`,
    };
  }

  function showJourney() {
    const name = element("train").value, against = element("against").value;
    const runs = run.runs.filter((each) => each.chosen !== null);
    const shown = runs.map((each) => journeyOf(each, name, against));
    const div = element("journey");
    const order = [0, 1, 2].flatMap((panel) => shown.map((each) => [panel, each]));
    Plotly.restyle(div, {
      x: order.map(([, each]) => each.x), y: order.map(([panel, each]) => each.y[panel]),
      name: order.map(([, each]) => each.name),
    }, order.map((_, k) => k));
    Plotly.relayout(div, {
      meta: against,
      "xaxis3.title.text": against === "time" ? "time [min]" : "position [km]",
      "xaxis.autorange": true, "xaxis2.autorange": true, "xaxis3.autorange": true,
    });
    showMoment(+slider.value);
  }

  // ---- tables

  function sort(button) {
    const heading = button.closest("th"), table = heading.closest("table");
    const column = heading.cellIndex, body = table.tBodies[0];
    const falling = heading.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", falling ? "descending" : "ascending");
    const value = (row) => row.cells[column].dataset.value;
    const compare = (a, b) => {
      if (a === "" || b === "") return (a === "") - (b === ""); // what is missing stands last
      const order = isNaN(a) || isNaN(b) ? a.localeCompare(b, "en", { numeric: true }) : a - b;
      return falling ? -order : order;
    };
    body.append(...[...body.rows].sort((a, b) => compare(value(a), value(b))));
  }

  function download(button) {
    const table = element(button.dataset.table);
    const quoted = (text) => (/[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text);
    const rows = [...table.rows].map((row) =>
      [...row.cells].map((cell) => quoted(cell.dataset.value ?? cell.textContent.trim())).join(","));
    const link = document.createElement("a");
    link.href = URL.createObjectURL(new Blob([rows.join("\n") + "\n"], { type: "text/csv" }));
    link.download = `${table.id}.csv`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 1000);
  }

  for (const button of document.querySelectorAll(".sortable thead button"))
    button.addEventListener("click", () => sort(button));
  for (const button of document.querySelectorAll(".csv"))
    button.addEventListener("click", () => download(button));

  // ---- on paper every plot is light, and has the width of the page

  const wishes = matchMedia("(prefers-color-scheme: dark)");
  wishes.addEventListener("change", () => paint(wishes.matches));

  addEventListener("beforeprint", () => {
    paint(false);
    for (const div of divs) {
      const most = div.layout.yaxis3 ? PRINTED.tall : PRINTED.height;
      const height = Math.min(most, heights.get(div));
      Plotly.relayout(div, { width: PRINTED.width, height });
    }
  });
  addEventListener("afterprint", () => {
    paint(wishes.matches);
    for (const div of divs)
      Plotly.relayout(div, { width: null, autosize: true, height: heights.get(div) });
  });

  Promise.all(divs.map(draw)).then(() => {
    if (slider) {
      slider.addEventListener("input", () => askFor(+slider.value * run.step_min));
      element("play").addEventListener("click", play);
      if (element("train")) for (const id of ["train", "against"])
        element(id).addEventListener("change", showJourney);
      setTime(0);
    }
    paint(wishes.matches);
    document.body.dataset.ready = "true";
  });
})();
