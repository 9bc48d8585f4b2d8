// Shows maps of what each pixel cost, with a slider between the picture and the map. It needs `--heat`.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number, short } from "../format.js";

const kViewerWidth = 512; // as in report.css
const kFirst = "active_cycles"; // map shown first: lanes of a warp end together, so "cycles" shows warps rather than pixels

const title = (map) => map.name.replaceAll("_", " ").replace("l1 ", "L1 ");
const unitOf = (map) => (map.unit === "fraction" ? "fraction" : `${map.unit}s a pixel`);

function legend(map, scale) {
  const marks = [0, 0.25, 0.5, 0.75, 1].map((part) => h("span", { style: `left:${100 * part}%` }, short(part * map.top)));
  return h("div", { class: "heat-legend" }, h("div", { class: "ramp", style: `background:linear-gradient(to right,${scale.join(",")})` }), h("div", { class: "marks" }, marks), h("p", { class: "note" }, unitOf(map), map.max > map.top ? `; what lies above ${short(map.top)} has the last colour` : ""));
}

// Shows the picture below, and the map above it from the slider's place on.
function viewer(run, maps) {
  const { width, height } = maps[0], factor = Math.floor(kViewerWidth / width);
  const size = factor ? `width:${factor * width}px` : `width:${kViewerWidth}px`;
  const image = h("img", { class: "over", alt: "" }), edge = h("div", { class: "edge" });
  const picture = run.data.picture ?? run.data.images?.find((image) => image.width === width && image.height === height)?.picture;
  const below = picture ? h("img", { class: "under", src: picture, alt: `Picture of ${run.workload}` }) : null;
  const box = h("div", { class: "viewer", style: `${size};aspect-ratio:${width}/${Math.max(height, width / 16)}` }, below, image, below ? edge : null);
  const slide = (percent) => {
    image.style.clipPath = `inset(0 0 0 ${percent}%)`;
    edge.style.left = `${percent}%`;
  };
  const slider = below ? h("input", { type: "range", min: "0", max: "100", value: "50", style: size, "aria-label": "Where the picture ends and the map begins", oninput: (event) => slide(event.target.value) }) : null;
  slide(below ? 50 : 0);
  return { image, element: h("div", {}, box, slider, slider ? h("div", { class: "ends", style: size }, h("span", {}, "picture"), h("span", {}, "map")) : null) };
}

function maps(run, scale, index) {
  const { heat } = run.data, { image, element } = viewer(run, heat);
  const about = h("div", { class: "heat-about", "aria-live": "polite" });
  const rows = heat.map((map) => {
    const pick = h("button", { type: "button", onclick: () => show(map) }, title(map));
    return h("tr", { "data-map": map.name }, h("td", { class: "thumb" }, h("img", { src: map.picture, alt: "" })), h("th", { scope: "row" }, pick), [map.min, map.mean, map.p99, map.max].map((value) => h("td", { class: "n", "data-value": value }, number(value))), h("td", { class: "u" }, map.unit));
  });
  const show = (map) => {
    image.src = map.picture;
    image.alt = `Map of ${title(map)}`;
    about.replaceChildren(h("h3", {}, title(map)), h("p", { class: "note" }, map.doc), map.max > 0 ? legend(map, scale) : h("p", { class: "note" }, "Every pixel has 0."));
    rows.forEach((row) => row.classList.toggle("chosen", row.dataset.map === map.name));
  };
  show(heat.find((map) => map.name === kFirst) ?? heat[0]);
  const head = ["", "Map", "Min", "Mean", "99 %", "Max", "Unit"].map((name, i) => h("th", { scope: "col", class: i > 1 && i < 6 ? "n" : null }, name));
  return h("div", { class: "heat-run", id: `heat-${index}` }, element, h("div", {}, about, h("div", { class: "scroll" }, h("table", { class: "maps" }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows)))));
}

export function heat(runs, scale) {
  const mapped = runs.filter((run) => run.data.heat?.length);
  if (!mapped.length) return null;
  return mapped.flatMap((run) => [runs.length > 1 ? h("h3", { class: "heat-title" }, run.label) : null, maps(run, scale, run.index)]);
}
