// Draws how often each value came: bars for one series, stepped lines of shares for several.
// SPDX-License-Identifier: Apache-2.0
import { number, percent, short } from "../format.js";
import { base, legend, tip, valueAxis } from "./common.js";

// `series` are {name, colour, counts}. `bins` is {low, high, step} of all of them. `unit` is the unit of values, and `what` that of counts.
export function histogram({ series, bins, unit, what }) {
  const totals = series.map((one) => one.counts.reduce((a, b) => a + b, 0));
  const length = Math.max(...series.map((one) => one.counts.length));
  const last = bins.low + bins.step * Math.ceil((bins.high - bins.low) / bins.step); // From here on, values are in the bin beyond.
  const name = (i) => {
    const from = bins.low + i * bins.step;
    return from >= last ? `from ${number(from)}` : `${number(from)} to ${number(from + bins.step - 1)}`;
  };
  const share = (k, i) => (totals[k] ? (series[k].counts[i] ?? 0) / totals[k] : 0);
  const names = series.length > 1 ? series.map((one) => one.name) : [];

  function option(t, width) {
    const top = legend(t, names, width);
    return {
      ...base(t),
      legend: top.option,
      grid: { left: 44, right: 12, top: top.height + 8, bottom: 42 },
      xAxis: {
        type: "category",
        data: Array.from({ length }, (_, i) => bins.low + i * bins.step),
        axisLine: { lineStyle: { color: t.line } },
        axisTick: { show: false },
        axisLabel: { color: t.muted, fontSize: 11, formatter: (value) => short(Number(value)), hideOverlap: true },
        name: unit,
        nameLocation: "middle",
        nameGap: 26,
        nameTextStyle: { color: t.muted, fontSize: 11 },
      },
      yAxis: valueAxis(t, (value) => `${Number((100 * value).toFixed(1))} %`),
      tooltip: {
        ...base(t).tooltip,
        trigger: "axis",
        axisPointer: { type: "line", lineStyle: { color: t.muted } },
        formatter: (items) => tip(`${name(items[0].dataIndex)} ${unit}`, items.map((item) => [item.color, item.seriesName, `${number(series[item.seriesIndex].counts[item.dataIndex] ?? 0)} &nbsp; ${percent(item.value)}`])),
      },
      series: series.map((one, k) => {
        const data = Array.from({ length }, (_, i) => share(k, i));
        const shared = { name: one.name, color: t.colour(one.colour), data, emphasis: { disabled: true } };
        if (series.length === 1) return { type: "bar", ...shared, barCategoryGap: "12%" };
        return { type: "line", ...shared, step: "middle", symbol: "none", lineStyle: { width: 1.6 } };
      }),
    };
  }
  return {
    option,
    height: (t, width) => legend(t, names, width).height + 210,
    columns: [`from (${unit})`, ...series.map((one) => `${one.name} (${what})`)],
    rows: Array.from({ length }, (_, i) => [bins.low + i * bins.step, ...series.map((one) => one.counts[i] ?? 0)]),
  };
}
