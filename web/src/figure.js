// Builds the frame of a figure: title, how to read it, chart, its numbers as table and CSV, and the drawing as SVG.
// SPDX-License-Identifier: Apache-2.0
import { BarChart, CustomChart, LineChart, RadarChart, ScatterChart } from "echarts/charts";
import { AxisPointerComponent, GridComponent, LegendComponent, RadarComponent, TitleComponent, TooltipComponent } from "echarts/components";
import * as echarts from "echarts/core";
import { LabelLayout } from "echarts/features";
import { SVGRenderer } from "echarts/renderers";

import { csv, download, h } from "./dom.js";
import { number } from "./format.js";
import { onSchemeChange, theme } from "./theme.js";

echarts.use([BarChart, CustomChart, LineChart, RadarChart, ScatterChart, AxisPointerComponent, GridComponent, LegendComponent, RadarComponent, TitleComponent, TooltipComponent, LabelLayout, SVGRenderer]);

const kMaxTableRows = 80; // longer tables are in the CSV only
const kExportWidth = 720;

const undrawn = []; // drawings of figures that wait for their place in the page

// Draws the figures that have been made and placed since the last call, without waiting for the browser's next frame.
export function drawPlaced() {
  for (const fit of undrawn.splice(0)) fit();
}

// Builds a figure of `chart`, which one of kinds/ made: {option(theme, width), height(theme, width), columns, rows}. `before` is an element between
// the note and the chart.
export function figure({ id, title, note, wide, before }, chart) {
  const canvas = h("div", { class: "canvas", role: "img", "aria-label": title });
  const element = h("figure", { id, class: wide ? "wide" : null }, h("h3", {}, title), note ? h("p", { class: "note" }, note) : null, before, canvas, h("figcaption", {}, ...tools(id, chart)));
  let drawn = null;
  const draw = (scheme) => {
    const t = theme(scheme), width = canvas.clientWidth;
    if (!width) return;
    const height = Math.round(chart.height(t, width));
    canvas.style.height = `${height}px`;
    if (drawn) drawn.dispose();
    drawn = echarts.init(canvas, null, { renderer: "svg", width, height });
    drawn.setOption(chart.option(t, width));
    canvas.querySelector("svg")?.setAttribute("viewBox", `0 0 ${width} ${height}`); // Print can scale it then.
  };
  let last = 0;
  const isNew = () => canvas.clientWidth !== last && ((last = canvas.clientWidth), true);
  undrawn.push(() => isNew() && draw());
  new ResizeObserver(() => isNew() && requestAnimationFrame(() => draw())).observe(canvas); // A chart changes the page's height, which must not happen within the observer.
  onSchemeChange(() => draw());
  window.addEventListener("beforeprint", () => draw("light"));
  window.addEventListener("afterprint", () => draw());
  return element;
}

// Returns those figures of a list of {info, make} that `data` has something for. `suffix` tells several of the same page apart.
export function figures(list, data, suffix = "") {
  const drawn = list.map(({ info, make }) => {
    const chart = make(data);
    return chart ? figure({ ...info, id: info.id + suffix, note: typeof info.note === "function" ? info.note(data) : info.note, before: info.before?.(data) }, chart) : null;
  }).filter(Boolean);
  return drawn.length ? h("div", { class: "figures" }, drawn) : null;
}

function tools(id, chart) {
  const table = chart.rows.length <= kMaxTableRows ? h("details", { class: "numbers" }, h("summary", {}, "Table"), h("div", { class: "scroll" }, dataTable(chart))) : null;
  return [
    table,
    h("button", { type: "button", onclick: () => download(`${id}.csv`, "text/csv", csv(chart.columns, chart.rows)) }, "CSV"),
    h("button", { type: "button", onclick: () => download(`${id}.svg`, "image/svg+xml", svg(chart)) }, "SVG"),
  ];
}

function dataTable(chart) {
  const cell = (value, i) => (i === 0 ? h("th", { scope: "row" }, String(value)) : h("td", { class: "n", "data-value": typeof value === "number" ? value : null }, typeof value === "number" || value === null ? number(value) : String(value)));
  return h("table", {}, h("thead", {}, h("tr", {}, chart.columns.map((name, i) => h("th", { scope: "col", class: i ? "n" : null }, name)))), h("tbody", {}, chart.rows.map((row) => h("tr", {}, row.map(cell)))));
}

// Returns the drawing as SVG. It is always in the light scheme, because it is for papers.
function svg(chart) {
  const t = theme("light"), height = Math.round(chart.height(t, kExportWidth));
  const drawing = echarts.init(null, null, { renderer: "svg", ssr: true, width: kExportWidth, height });
  drawing.setOption(chart.option(t, kExportWidth));
  const text = drawing.renderToSVGString();
  drawing.dispose();
  return text;
}
