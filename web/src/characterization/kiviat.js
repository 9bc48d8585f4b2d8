// Draws a Kiviat diagram for each workload over the representative metrics (LumiBench, Figure 4).
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { number } from "../format.js";
import { base, tip } from "../kinds/common.js";
import { clusterColour } from "./shared.js";

const kCell = 138, kRow = 150, kRadius = 44, kTitle = 20;
const across = (width) => Math.max(1, Math.floor(width / kCell));

// Lists what the spokes are, and what their ends stand for.
const spokes = (data) => h("ol", { class: "note spokes" }, data.axes.map((axis) => h("li", {}, h("code", {}, axis.name), ` ${number(axis.least)} to ${number(axis.most)} ${axis.unit}`)));

export const info = {
  id: "kiviats", wide: true, title: "Kiviat diagrams", before: spokes,
  note: "Spokes are the metrics that tell the workloads apart best, each from the least of all workloads in the centre to the most at the rim. Workloads come in the order of the dendrogram and have the colour of their cluster. Clockwise from the top, the spokes are:",
};

export function make(data) {
  const order = data.leaves.map((row) => data.workloads[row]);
  if (data.axes.length < 3) return null; // two spokes enclose no area
  const option = (t, width) => {
    const columns = across(width), step = width / columns;
    const centre = (i) => [step * ((i % columns) + 0.5), kTitle + kRow * Math.floor(i / columns) + kCell / 2];
    return {
      ...base(t),
      title: order.map((one, i) => ({ text: one.name, left: centre(i)[0], top: centre(i)[1] - kCell / 2 - 9, textAlign: "center", padding: 0, textStyle: { fontSize: 11, fontWeight: one.chosen ? 700 : 400, color: t.ink, fontFamily: t.font } })),
      radar: order.map((_, i) => ({
        center: centre(i), radius: kRadius, splitNumber: 2, axisNameGap: 3, startAngle: 90, clockwise: true,
        indicator: data.axes.map((_axis, k) => ({ name: String(k + 1), min: 0, max: 1 })),
        axisName: { color: t.muted, fontSize: 8 },
        axisLine: { lineStyle: { color: t.line } }, splitLine: { lineStyle: { color: t.line } }, splitArea: { show: false },
      })),
      tooltip: { ...base(t).tooltip, formatter: ({ seriesIndex }) => tip(order[seriesIndex].name, data.axes.map((axis, k) => [null, `${k + 1} ${axis.name}`, number(axis.least + order[seriesIndex].kiviat[k] * (axis.most - axis.least))])) },
      series: order.map((one, i) => {
        const colour = t.colour(clusterColour(one.cluster));
        return { type: "radar", radarIndex: i, symbol: "none", lineStyle: { color: colour, width: 1.4 }, areaStyle: { color: colour, opacity: 0.28 }, emphasis: { disabled: true }, data: [{ value: one.kiviat }] };
      }),
    };
  };
  return {
    option,
    height: (t, width) => kTitle + kRow * Math.ceil(order.length / across(width)),
    columns: ["workload", "cluster", ...data.axes.map((axis) => `${axis.name} (0 to 1)`)],
    rows: order.map((one) => [one.name, one.cluster + 1, ...one.kiviat]),
  };
}
