// Draws the eigenvalues of the correlation matrix, and shows which of them are kept.
// SPDX-License-Identifier: Apache-2.0
import { number, percent } from "../format.js";
import { base, categoryAxis, tip, valueAxis } from "../kinds/common.js";

const kMost = 20; // components shown
const kHeight = 230;

export const info = {
  id: "scree", wide: true, title: "Eigenvalues",
  note: (data) => `A bar is the variance along a component, in metrics' worth. Above 1 the component says more than a single metric, and is kept (${data.kept} of ${data.eigenvalues.length}).`,
};

export function make(data) {
  const shown = data.eigenvalues.slice(0, kMost), total = data.eigenvalues.reduce((a, b) => a + b, 0);
  const names = shown.map((_, i) => `PC${i + 1}`);
  const option = (t) => ({
    ...base(t),
    grid: { left: 34, right: 8, top: 8, bottom: 26 },
    xAxis: { ...categoryAxis(t, names.map((name) => name.slice(2))), axisLabel: { color: t.muted, fontSize: 11, interval: 0 } },
    yAxis: valueAxis(t, number),
    tooltip: { ...base(t).tooltip, trigger: "axis", axisPointer: { type: "none" }, formatter: ([item]) => tip(names[item.dataIndex], [[null, "eigenvalue", number(shown[item.dataIndex])], [null, "of the variance", percent(shown[item.dataIndex] / total)]]) },
    series: [
      { type: "bar", barWidth: "62%", emphasis: { disabled: true }, data: shown.map((value, i) => ({ value, itemStyle: { color: t.colour(i < data.kept ? "blue" : "pale") } })) },
      { type: "line", symbol: "none", silent: true, lineStyle: { color: t.colour("red"), width: 1, type: "dashed" }, data: shown.map(() => 1) },
    ],
  });
  return { option, height: () => kHeight, columns: ["component", "eigenvalue", "share of the variance"], rows: data.eigenvalues.map((value, i) => [`PC${i + 1}`, value, value / total]) };
}
