// Draws the page of a sweep: filters, front, effects, parallel coordinates, best points, and a panel for each point.
// SPDX-License-Identifier: Apache-2.0
"use strict";
(() => {
  const data = JSON.parse(document.getElementById("data").textContent);
  const page = document.getElementById("page");
  const at = (name, i) => { const column = data.columns[name]; return column === undefined ? null : column[column.length === 1 ? 0 : i]; };
  const metrics = Object.keys(data.metrics);
  const more = new Map([...data.objectives, ...data.axes]);
  const state = { x: (data.axes[0] || [metrics[0]])[0], y: (data.axes[1] || data.axes[0] || [metrics[0]])[0], colour: data.factors[0] || "", best: (data.objectives[0] || [metrics[0]])[0], filters: new Map() };
  let shown = [];

  const make = (tag, attributes = {}, ...children) => {
    const out = document.createElement(tag);
    for (const [name, value] of Object.entries(attributes)) name.startsWith("on") ? out.addEventListener(name.slice(2), value) : out.setAttribute(name, value);
    out.append(...children);
    return out;
  };
  const text = (value) => value === null || value === undefined ? "–" : typeof value === "number" ? (Number.isInteger(value) ? value.toLocaleString("en") : Number(value.toPrecision(5)).toLocaleString("en", { maximumFractionDigits: 12 })) : String(value);
  const short = (name, value) => name === "workload" || name === "config" ? String(value).split("/").pop() : text(value);
  const ink = (name) => getComputedStyle(document.documentElement).getPropertyValue(name);
  const COLOURS = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#f0e442", "#999999"];
  const valuesOf = (name) => {
    const found = [...new Set(data.columns[name])].filter((value) => value !== null);
    return found.every((value) => typeof value === "number") ? found.sort((a, b) => a - b) : found.sort();
  };
  const values = Object.fromEntries(data.factors.map((name) => [name, valuesOf(name)]));
  const isRange = (name) => values[name].length > 12 && values[name].every((value) => typeof value === "number");
  const colourOf = (i) => {
    const known = values[state.colour];
    if (!known) return COLOURS[0];
    const place = known.indexOf(at(state.colour, i));
    return known.length <= COLOURS.length ? COLOURS[place] : `hsl(${240 - 240 * place / (known.length - 1)} 75% 50%)`;
  };

  // --- filters: for each factor or metric, a set of values or a range ---
  const passes = (i) => {
    for (const [name, rule] of state.filters) {
      const value = at(name, i);
      if (rule instanceof Set ? !rule.has(value) : value === null || value < rule[0] || value > rule[1]) return false;
    }
    return true;
  };
  const filterOf = (name) => {
    const box = make("fieldset", {}, make("legend", {}, name));
    if (isRange(name)) {
      const bounds = [values[name][0], values[name].at(-1)];
      const fields = bounds.map((bound) => make("input", { type: "number", step: "any", value: bound, "aria-label": name }));
      for (const field of fields) field.addEventListener("input", () => { state.filters.set(name, fields.map((one, k) => one.value === "" ? bounds[k] : Number(one.value))); update(); });
      box.append(fields[0], " to ", fields[1]);
      return box;
    }
    const chosen = new Set(values[name]);
    for (const value of values[name]) {
      const tick = make("input", { type: "checkbox" });
      tick.checked = true;
      tick.addEventListener("change", () => { tick.checked ? chosen.add(value) : chosen.delete(value); chosen.size === values[name].length ? state.filters.delete(name) : state.filters.set(name, chosen); update(); });
      box.append(make("label", {}, tick, short(name, value)));
    }
    return box;
  };
  const choice = (label, key, names) => {
    const list = make("select", { onchange: () => { state[key] = list.value; update(); } }, ...names.map((name) => make("option", { value: name }, name)));
    list.value = state[key];
    return make("label", {}, label, list);
  };

  // --- canvases ---
  const canvas = (height) => make("canvas", { style: `height:${height}px`, role: "img" });
  const begin = (view) => {
    const ratio = window.devicePixelRatio || 1, width = view.clientWidth || 1100, height = view.clientHeight || 380;
    view.width = width * ratio; view.height = height * ratio;
    const draw = view.getContext("2d");
    draw.scale(ratio, ratio);
    draw.font = "12px system-ui, sans-serif"; draw.fillStyle = ink("--ink"); draw.strokeStyle = ink("--line");
    return [draw, width, height];
  };
  const extent = (name, rows) => {
    let low = Infinity, high = -Infinity;
    for (const i of rows) { const value = at(name, i); if (typeof value === "number") { low = Math.min(low, value); high = Math.max(high, value); } }
    return low > high ? [0, 1] : low === high ? [low - 0.5, high + 0.5] : [low, high];
  };
  const front = (rows) => {
    const sign = (name) => more.get(name) ? -1 : 1, points = [];
    for (const i of rows) { const a = at(state.x, i), b = at(state.y, i); if (typeof a === "number" && typeof b === "number") points.push([sign(state.x) * a, sign(state.y) * b, i]); }
    points.sort((p, q) => p[0] - q[0] || p[1] - q[1]);
    let best = Infinity;
    let last = null;
    return points.filter(([a, b]) => { const keeps = b < best || (last && b === last[1] && a === last[0]); if (b < best) { best = b; last = [a, b]; } return keeps; }).map((point) => point[2]);
  };
  const scatter = canvas(400), coordinates = canvas(320), tip = make("div", { class: "tip", hidden: "" });
  let places = [];
  const drawScatter = () => {
    const [draw, width, height] = begin(scatter), left = 70, bottom = height - 40;
    const [x0, x1] = extent(state.x, shown), [y0, y1] = extent(state.y, shown);
    const px = (value) => left + 10 + (width - left - 30) * (value - x0) / (x1 - x0), py = (value) => bottom - 10 - (bottom - 30) * (value - y0) / (y1 - y0);
    draw.strokeRect(left, 10, width - left - 10, bottom - 10);
    for (let k = 0; k <= 4; ++k) {
      draw.textAlign = k === 4 ? "right" : "center"; draw.fillText(text(Number((x0 + (x1 - x0) * k / 4).toPrecision(4))), px(x0 + (x1 - x0) * k / 4), bottom + 16);
      draw.textAlign = "right"; draw.fillText(text(Number((y0 + (y1 - y0) * k / 4).toPrecision(4))), left - 6, py(y0 + (y1 - y0) * k / 4) + 4);
    }
    draw.textAlign = "center"; draw.fillText(`${state.x} (${data.metrics[state.x][0]})${more.get(state.x) ? ", more is better" : ", less is better"}`, (left + width) / 2, bottom + 33);
    draw.save(); draw.translate(13, bottom / 2); draw.rotate(-Math.PI / 2); draw.fillText(`${state.y} (${data.metrics[state.y][0]})${more.get(state.y) ? ", more is better" : ""}`, 0, 0); draw.restore();
    places = [];
    draw.globalAlpha = shown.length > 2000 ? 0.4 : 0.8;
    for (const i of shown) {
      const a = at(state.x, i), b = at(state.y, i);
      if (typeof a !== "number" || typeof b !== "number") continue;
      const place = [px(a), py(b), i];
      places.push(place);
      draw.fillStyle = colourOf(i);
      draw.fillRect(place[0] - 2, place[1] - 2, 4, 4);
    }
    draw.globalAlpha = 1;
    const best = front(shown);
    draw.strokeStyle = ink("--front"); draw.lineWidth = 1.5; draw.beginPath();
    best.forEach((i, k) => { const a = px(at(state.x, i)), b = py(at(state.y, i)); k ? draw.lineTo(a, b) : draw.moveTo(a, b); });
    draw.stroke();
    for (const i of best) { draw.beginPath(); draw.arc(px(at(state.x, i)), py(at(state.y, i)), 4.5, 0, 7); draw.stroke(); }
    document.getElementById("front").textContent = `${best.length} of ${shown.length} points are on the Pareto front of ${state.x} and ${state.y}.`;
  };
  const axes = [...data.factors, ...data.objectives.map(([name]) => name), ...data.axes.map(([name]) => name)].filter((name, k, all) => all.indexOf(name) === k);
  const everything = Array.from({ length: data.count }, (_, i) => i);
  const scale = Object.fromEntries(axes.map((name) => {
    const known = values[name];
    if (known && !known.every((value) => typeof value === "number")) return [name, (value) => known.length > 1 ? known.indexOf(value) / (known.length - 1) : 0.5];
    const [low, high] = extent(name, everything);
    return [name, (value) => (value - low) / (high - low)];
  }));
  const axisX = (k, width) => 60 + (width - 120) * (axes.length > 1 ? k / (axes.length - 1) : 0.5);
  const drawCoordinates = () => {
    const [draw, width, height] = begin(coordinates), y = (part) => height - 24 - (height - 70) * part;
    draw.lineWidth = 1;
    draw.globalAlpha = Math.max(0.06, Math.min(0.7, 250 / (shown.length + 1)));
    for (const i of shown) {
      draw.strokeStyle = colourOf(i);
      draw.beginPath();
      let on = false;
      axes.forEach((name, k) => { const value = at(name, i); if (value === null) { on = false; return; } const place = [axisX(k, width), y(scale[name](value))]; on ? draw.lineTo(...place) : draw.moveTo(...place); on = true; });
      draw.stroke();
    }
    draw.globalAlpha = 1; draw.textAlign = "center";
    axes.forEach((name, k) => {
      const x = axisX(k, width), known = values[name], rule = state.filters.get(name), [low, high] = extent(name, everything);
      const ends = known && typeof known[0] !== "number" ? [short(name, known[0]), short(name, known.at(-1))] : [text(low), text(high)];
      draw.strokeStyle = ink("--ink"); draw.beginPath(); draw.moveTo(x, y(0)); draw.lineTo(x, y(1)); draw.stroke();
      draw.fillStyle = ink("--ink"); draw.fillText(name.length > 22 ? "…" + name.slice(-21) : name, x, k % 2 ? 30 : 14); draw.fillText(ends[0], x, height - 8); draw.fillText(ends[1], x, y(1) - 4);
      if (Array.isArray(rule)) { draw.fillStyle = ink("--front"); draw.globalAlpha = 0.35; const a = y(scale[name](rule[1])), b = y(scale[name](rule[0])); draw.fillRect(x - 6, a, 12, b - a); draw.globalAlpha = 1; }
    });
  };
  let brush = null;
  coordinates.addEventListener("pointerdown", (event) => {
    const box = coordinates.getBoundingClientRect(), k = axes.findIndex((_, one) => Math.abs(axisX(one, box.width) - (event.clientX - box.left)) < 12);
    if (k >= 0 && typeof extent(axes[k], everything)[0] === "number" && !(values[axes[k]] && typeof values[axes[k]][0] !== "number")) { brush = { name: axes[k], from: event.clientY - box.top }; coordinates.setPointerCapture(event.pointerId); }
  });
  const partOf = (pixel, height) => Math.min(1, Math.max(0, (height - 24 - pixel) / (height - 70)));
  coordinates.addEventListener("pointermove", (event) => {
    if (!brush) return;
    const box = coordinates.getBoundingClientRect(), [low, high] = extent(brush.name, everything);
    const ends = [brush.from, event.clientY - box.top].map((pixel) => low + (high - low) * partOf(pixel, box.height)).sort((a, b) => a - b);
    Math.abs(event.clientY - box.top - brush.from) < 4 ? state.filters.delete(brush.name) : state.filters.set(brush.name, ends);
    update();
  });
  coordinates.addEventListener("pointerup", () => { brush = null; });
  const nearest = (event) => {
    const box = scatter.getBoundingClientRect(), x = event.clientX - box.left, y = event.clientY - box.top;
    let best = null, distance = 64;
    for (const place of places) { const one = (place[0] - x) ** 2 + (place[1] - y) ** 2; if (one < distance) { distance = one; best = place[2]; } }
    return best;
  };
  scatter.addEventListener("pointermove", (event) => {
    const i = nearest(event);
    tip.hidden = i === null;
    if (i === null) return;
    tip.textContent = data.factors.map((name) => `${name} ${short(name, at(name, i))}`).join(", ") + `: ${state.x} ${text(at(state.x, i))}, ${state.y} ${text(at(state.y, i))}`;
    tip.style.left = `${Math.min(event.clientX + 12, window.innerWidth - 320)}px`; tip.style.top = `${event.clientY + 12}px`;
  });
  scatter.addEventListener("pointerleave", () => { tip.hidden = true; });
  scatter.addEventListener("click", (event) => { const i = nearest(event); if (i !== null) openPoint(i); });

  // --- tables ---
  const table = (head, rows, numbers = []) => make("div", { class: "wide" }, make("table", {}, make("thead", {}, make("tr", {}, ...head.map((name, k) => make("th", numbers.includes(k) ? { class: "number" } : {}, name)))), make("tbody", {}, ...rows)));
  const cell = (value) => make("td", typeof value === "number" ? { class: "number" } : {}, value instanceof Node ? value : text(value));
  const best = make("div"), dialog = make("dialog", { onclick: (event) => { if (event.target === dialog) dialog.close(); } });
  const drawBest = () => {
    const sign = more.get(state.best) ? -1 : 1;
    const rows = shown.filter((i) => typeof at(state.best, i) === "number").sort((a, b) => sign * (at(state.best, a) - at(state.best, b))).slice(0, 20);
    best.replaceChildren(table([state.best, ...data.factors, ...data.axes.map(([name]) => name).filter((name) => name !== state.best), "point"], rows.map((i) => make("tr", { "data-row": i, onclick: () => openPoint(i) },
      cell(at(state.best, i)), ...data.factors.map((name) => cell(typeof at(name, i) === "number" ? at(name, i) : short(name, at(name, i)))), ...data.axes.map(([name]) => name).filter((name) => name !== state.best).map((name) => cell(at(name, i))), cell(at("id", i).slice(0, 8)))), [0]));
  };
  const openPoint = (i) => {
    const id = at("id", i), own = data.links.file ? [make("p", {}, make("a", { href: `${data.links.prefix}/${id.slice(0, 3)}/${id}/${data.links.file}` }, "The report of this point"))] : [];
    dialog.replaceChildren(make("h2", {}, `${short("workload", at("workload", i))} on ${short("config", at("config", i))}`), make("p", {}, ...data.keys.map((name) => `${name} = ${text(at(name, i))}  `)), ...own,
      make("p", { class: "faint" }, "As a run directory: ", make("code", {}, `glint sweep open --store ${data.store} --point ${id} --out ${id.slice(0, 8)}`)),
      table(["metric", "value", "unit", "meaning"], metrics.map((name) => make("tr", {}, cell(name), cell(at(name, i)), cell(data.metrics[name][0]), cell(data.metrics[name][1]))), [1]), make("button", { onclick: () => dialog.close() }, "Close"));
    dialog.showModal();
  };
  const effectsOf = (name) => {
    const rows = data.effects[name].map(([key, share, interval, total, span, levels]) => {
      const means = levels.map((level) => level[1]), low = Math.min(...means), high = Math.max(...means);
      const bars = make("div", { class: "levels" }, ...levels.slice(0, 24).map(([level, mean, count]) => make("i", { style: `height:${high > low ? 6 + 42 * (mean - low) / (high - low) : 24}px`, title: `${level}: mean ${text(mean)} over ${count} points` })));
      const between = interval.length ? `${(100 * interval[0]).toFixed(1)} to ${(100 * interval[1]).toFixed(1)} %` : "–";
      return make("tr", {}, cell(key), cell(make("span", { class: "bar", style: `width:${Math.max(0, 120 * share).toFixed(0)}px` })), cell(`${(100 * share).toFixed(1)} %`), cell(between), cell(total === null ? "–" : `${(100 * total).toFixed(1)} %`), cell(span), cell(bars));
    });
    return [make("h2", {}, `What moves ${name}`), make("p", { class: "faint" }, "Share of the variance that lies between the means of a key's values (first-order index), its 95 % interval, the total index with interactions where the design gives it, and the means by value."),
      table(["key", "", "share", "95 %", "total", "span of means", "mean by value, from the lowest mean"], rows)];
  };

  // --- the page ---
  let waiting = false;
  const update = () => {
    shown = everything.filter(passes);
    if (waiting) return;
    waiting = true;
    requestAnimationFrame(() => {
      waiting = false;
      document.getElementById("shown").textContent = `${shown.length} of ${data.count} points pass the filters.`;
      if (metrics.length) { drawScatter(); drawCoordinates(); drawBest(); }
      if (!document.documentElement.dataset.ready) document.documentElement.dataset.milliseconds = Math.round(performance.now());
      document.documentElement.dataset.ready = "yes";
    });
  };
  const failed = data.failed ? [make("h2", {}, `${data.failed} points failed`), table(["kind", "point", "message", "id"], data.failures.map(([id, kind, title, message]) => make("tr", {}, cell(kind), cell(title), cell(message.split("\n")[0]), cell(id.slice(0, 8)))))] : [];
  page.append(make("h1", {}, `Sweep ${data.name}`), make("p", { class: "faint" }, `${data.count} points${data.failed ? `, ${data.failed} failed` : ""}${data.missing ? `, ${data.missing} not run yet` : ""}. A click on a point shows all of its numbers.`),
    make("h2", {}, "Filters"), make("div", { class: "row" }, ...data.factors.map(filterOf), make("button", { onclick: () => location.reload() }, "Reset")), make("p", { id: "shown", class: "faint" }),
    make("h2", {}, "Points and their Pareto front"), make("div", { class: "row" }, choice("across", "x", metrics), choice("up", "y", metrics), choice("colour", "colour", data.factors)), scatter, make("p", { id: "front", class: "faint" }),
    make("h2", {}, "Best points"), make("div", { class: "row" }, choice("by", "best", metrics)), best,
    make("h2", {}, "Parallel coordinates"), make("p", { class: "faint" }, "Drag along an axis to keep only the lines that pass there, and click on the axis to keep all."), coordinates,
    ...data.objectives.flatMap(([name]) => data.effects[name] ? effectsOf(name) : []), ...failed, dialog, tip);
  window.addEventListener("resize", update);
  update();
})();
