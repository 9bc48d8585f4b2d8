// Draws which workloads join at which distance (LumiBench, Figure 3).
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { base, textWidth, tip, valueAxis } from "../kinds/common.js";
import { clusterColour } from "./shared.js";

const kRow = 17;

export const info = {
  id: "dendrogram", wide: true, title: "Dendrogram",
  note: (data) => `${data.linkage[0].toUpperCase()}${data.linkage.slice(1)} linkage joined the groups, on Euclidean distance in the ${data.kept} components. The dashed line cuts the tree into ${data.clusters} clusters; filled circles are their representatives${data.reference.known ? `, open ones ${data.reference.name}` : ""}.`,
};

// Returns where every group lies: its row (between those of its two parts), its distance, and its cluster, or -1 where it joins several.
function places(data) {
  const n = data.workloads.length, out = [];
  data.leaves.forEach((row, i) => (out[row] = { at: i, distance: 0, cluster: data.workloads[row].cluster }));
  data.joins.forEach(([a, b, distance], i) => (out[n + i] = { at: (out[a].at + out[b].at) / 2, distance, cluster: out[a].cluster === out[b].cluster ? out[a].cluster : -1 }));
  return out;
}

const names = (data, node) => (node < data.workloads.length ? [data.workloads[node].name] : data.joins[node - data.workloads.length].slice(0, 2).flatMap((part) => names(data, part)));

export function make(data) {
  const n = data.workloads.length, place = places(data), cut = (data.cut[0] + data.cut[1]) / 2;
  const leafName = (i) => data.workloads[data.leaves[i]]?.name ?? "";
  const option = (t) => ({
    ...base(t),
    grid: { left: Math.max(...data.workloads.map((one) => textWidth(one.name, 11))) + 30, right: 16, top: 4, bottom: 44 },
    xAxis: { ...valueAxis(t, number), name: "distance", min: 0 },
    yAxis: { type: "value", inverse: true, min: -1, max: n, interval: 1, axisLine: { show: false }, axisTick: { show: false }, splitLine: { show: false }, axisLabel: { color: t.ink, fontSize: 11, margin: 18, formatter: (i) => leafName(i) } },
    tooltip: { ...base(t).tooltip, formatter: ({ seriesIndex }) => (seriesIndex < data.joins.length ? tip(`joined at ${number(data.joins[seriesIndex][2])}`, data.joins[seriesIndex].slice(0, 2).map((node) => [null, names(data, node).slice(0, 6).join(", ") + (names(data, node).length > 6 ? ` and ${names(data, node).length - 6} more` : ""), ""])) : "") },
    series: [
      ...data.joins.map(([a, b, distance], i) => {
        const colour = place[n + i].cluster < 0 ? t.muted : t.colour(clusterColour(place[n + i].cluster));
        return { type: "line", symbol: "none", triggerLineEvent: true, lineStyle: { color: colour, width: 1.6 }, emphasis: { lineStyle: { width: 3 } }, data: [[place[a].distance, place[a].at], [distance, place[a].at], [distance, place[b].at], [place[b].distance, place[b].at]] };
      }),
      // A cluster of one has no join of its own colour, so its branch is drawn up to the cut.
      ...data.leaves.filter((row) => data.workloads.filter((one) => one.cluster === data.workloads[row].cluster).length === 1).map((row) => ({ type: "line", symbol: "none", silent: true, lineStyle: { color: t.colour(clusterColour(data.workloads[row].cluster)), width: 1.6 }, data: [[0, place[row].at], [cut, place[row].at]] })),
      { type: "line", symbol: "none", silent: true, lineStyle: { color: t.muted, width: 1, type: "dashed" }, data: [[cut, -0.8], [cut, n - 0.2]] },
      { type: "scatter", silent: true, symbolSize: 8, symbolOffset: [-7, 0], data: data.leaves.flatMap((row, i) => (data.workloads[row].chosen ? [{ value: [0, i], itemStyle: { color: t.colour(clusterColour(data.workloads[row].cluster)) } }] : [])) },
      { type: "scatter", silent: true, symbolSize: 11, symbolOffset: [-7, 0], data: data.leaves.flatMap((row, i) => (data.workloads[row].reference ? [{ value: [0, i], itemStyle: { color: "transparent", borderColor: t.ink, borderWidth: 1.2 } }] : [])) },
    ],
  });
  return {
    option,
    height: () => (n + 1) * kRow + 48,
    columns: ["join", "first", "second", "distance", "leaves"],
    rows: data.joins.map(([a, b, distance, size], i) => [n + i, a, b, distance, size]),
  };
}
