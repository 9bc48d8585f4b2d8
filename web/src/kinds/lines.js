// Draws values over time, one panel above the other along the same axis.
// SPDX-License-Identifier: Apache-2.0
import { number, short } from "../format.js";
import { base, legend, tip, valueAxis } from "./common.js";

const kPanel = 108, kGap = 30;

// `panels` are {name, unit, format, series: [{name, colour, x, y}]}. The series of every panel have the same names.
export function lines({ panels, unit }) {
  const names = panels[0].series.length > 1 ? panels[0].series.map((one) => one.name) : [];
  const end = Math.max(...panels[0].series.map((one) => one.x[one.x.length - 1] ?? 0));

  function option(t, width) {
    const top = legend(t, names, width);
    const at = (i) => top.height + 24 + i * (kPanel + kGap);
    return {
      ...base(t),
      legend: top.option,
      title: panels.map((panel, i) => ({ text: panel.name, left: 0, top: at(i) - 22, padding: 0, textStyle: { fontSize: 12, fontWeight: 600, color: t.ink, fontFamily: t.font } })),
      axisPointer: { link: [{ xAxisIndex: "all" }], lineStyle: { color: t.muted } },
      grid: panels.map((_, i) => ({ left: 44, right: 12, top: at(i), height: kPanel - 8 })),
      xAxis: panels.map((_, i) => ({
        ...valueAxis(t, (value) => short(value), i === panels.length - 1 ? unit : undefined),
        gridIndex: i,
        max: end,
        splitLine: { show: false },
        splitNumber: 6,
        axisLine: { show: true, onZero: false, lineStyle: { color: t.line } },
        axisLabel: { show: i === panels.length - 1, color: t.muted, fontSize: 11, formatter: (value) => (value === end ? "" : short(value)) },
      })),
      yAxis: panels.map((panel, i) => ({ ...valueAxis(t, panel.format), gridIndex: i, splitNumber: 2, min: 0, max: panel.max })),
      tooltip: {
        ...base(t).tooltip,
        trigger: "axis",
        formatter: (items) => tip(`${unit} ${number(items[0].value[0])}`, items.map((item) => [item.color, `${panels[item.axisIndex].name}${names.length ? ` – ${item.seriesName}` : ""}`, panels[item.axisIndex].format(item.value[1])])),
      },
      series: panels.flatMap((panel, i) =>
        panel.series.map((one) => ({
          type: "line",
          name: one.name,
          color: t.colour(one.colour),
          xAxisIndex: i,
          yAxisIndex: i,
          symbol: "none",
          lineStyle: { width: 1.4 },
          areaStyle: panel.series.length === 1 ? { opacity: 0.14 } : undefined,
          emphasis: { disabled: true },
          data: one.x.map((x, k) => [x, one.y[k]]),
        })),
      ),
    };
  }
  return {
    option,
    height: (t, width) => legend(t, names, width).height + 24 + panels.length * (kPanel + kGap) + 16,
    columns: [panels[0].series.length > 1 ? "run" : "", unit, ...panels.map((panel) => panel.name)],
    rows: panels[0].series.flatMap((one, k) => one.x.map((x, i) => [one.name, x, ...panels.map((panel) => panel.series[k].y[i])])),
  };
}
