// Draws the workloads in the plane of two components. Workloads that are alike lie near each other.
// SPDX-License-Identifier: Apache-2.0
import { number, percent } from "../format.js";
import { base, legend, tip, valueAxis } from "../kinds/common.js";
import { clusterColour, marks } from "./shared.js";

const kHeight = 420;

const middle = (values) => (Math.min(...values) + Math.max(...values)) / 2;

function plane(data, x, y) {
  if (data.kept <= y) return null;
  const shaders = marks(data), share = (i) => percent(data.eigenvalues[i] / data.eigenvalues.reduce((a, b) => a + b, 0));
  // A name stands on the side where the plane has room for it.
  const side = (one) => (one.scores[x] > middle(data.workloads.map((each) => each.scores[x])) ? "left" : "right");
  const axis = (t, i) => ({ ...valueAxis(t, number), name: `PC${i + 1} · ${share(i)} of the variance`, scale: true, axisLine: { show: true, onZero: true, lineStyle: { color: t.line } } });
  const option = (t, width) => {
    const top = legend(t, shaders.map((one) => one.name).filter(Boolean), width);
    return {
      ...base(t),
      legend: { ...top.option, icon: undefined, itemStyle: { color: t.muted } },
      grid: { left: 48, right: 12, top: top.height + 6, bottom: 46 },
      xAxis: axis(t, x),
      yAxis: { ...axis(t, y), nameGap: 34 },
      tooltip: { ...base(t).tooltip, formatter: ({ value: [, , index] }) => tip(data.workloads[index].name, [[t.colour(clusterColour(data.workloads[index].cluster)), `cluster ${data.workloads[index].cluster + 1}`, data.workloads[index].chosen ? "its representative" : ""], ...[x, y].map((i) => [null, `PC${i + 1}`, number(data.workloads[index].scores[i])])]) },
      series: shaders.map(({ name, mark }) => ({
        type: "scatter",
        name,
        symbol: mark,
        symbolSize: 9,
        color: t.muted,
        label: { show: true, distance: 4, fontSize: 10, color: t.muted, formatter: ({ value: [, , index] }) => (data.workloads[index].chosen ? data.workloads[index].name : "") },
        labelLayout: { hideOverlap: true },
        emphasis: { disabled: true },
        data: data.workloads.flatMap((one, index) => (one.shader === name ? [{ value: [one.scores[x], one.scores[y], index], label: { position: side(one) }, itemStyle: { color: t.colour(clusterColour(one.cluster)), borderColor: one.chosen ? t.ink : t.page, borderWidth: one.chosen ? 1.5 : 0.5 } }] : [])),
      })),
    };
  };
  return { option, height: () => kHeight, columns: ["workload", "shader", "cluster", `PC${x + 1}`, `PC${y + 1}`], rows: data.workloads.map((one) => [one.name, one.shader, one.cluster + 1, one.scores[x], one.scores[y]]) };
}

const note = "Colour: cluster. Outlined and named: its representative.";
export const first = { info: { id: "plane-1-2", title: "Components 1 and 2", note }, make: (data) => plane(data, 0, 1) };
export const second = { info: { id: "plane-3-4", title: "Components 3 and 4", note }, make: (data) => plane(data, 2, 3) };
