// Draws horizontal bars of single values with the value at their end. Several series stand side by side.
// SPDX-License-Identifier: Apache-2.0
import { number } from "../format.js";
import { base, categoryAxis, legend, textWidth, tip, valueAxis } from "./common.js";

// `rows` are labels. `series` are {name, colour, values: one for each row, null for none; labels: their texts, which `format` makes otherwise}. `max`
// is the end of the axis.
export function bars({ rows, series, unit, format = number, max, axis = format }) {
  const thick = series.length > 3 ? 10 : series.length > 1 ? 13 : 16;
  const text = (one, i) => one.labels?.[i] ?? format(one.values[i] ?? null);
  const names = series.length > 1 ? series.map((one) => one.name) : [];

  function option(t, width) {
    const left = Math.min(Math.max(...rows.map((row) => textWidth(row))) + 18, width * 0.42);
    const top = legend(t, names, width);
    const longest = Math.max(...series.flatMap((one) => rows.map((_, i) => textWidth(text(one, i)))));
    return {
      ...base(t),
      legend: top.option,
      grid: { left, right: longest + 14, top: top.height, bottom: 24 },
      xAxis: { ...valueAxis(t, axis), min: 0, ...(max === undefined ? {} : { max, interval: max / 4 }) },
      yAxis: { ...categoryAxis(t, rows, left - 8), inverse: true },
      tooltip: {
        ...base(t).tooltip,
        trigger: "axis",
        axisPointer: { type: "none" },
        formatter: (items) => tip(rows[items[0].dataIndex], items.map((item) => [item.color, item.seriesName, text(series[item.seriesIndex], item.dataIndex)])),
      },
      series: series.map((one) => ({
        type: "bar",
        name: one.name,
        color: t.colour(one.colour),
        barWidth: thick,
        barGap: "15%",
        showBackground: max !== undefined && series.length === 1,
        backgroundStyle: { color: t.line },
        label: { show: true, position: "right", fontSize: 11, color: t.ink, formatter: ({ dataIndex }) => text(one, dataIndex) },
        emphasis: { disabled: true },
        data: one.values,
      })),
    };
  }
  return {
    option,
    height: (t, width) => legend(t, names, width).height + rows.length * (series.length * thick * 1.15 + 13) + 26,
    columns: ["", ...series.map((one) => (unit ? `${one.name} (${unit})` : one.name))],
    rows: rows.map((row, i) => [row, ...series.map((one) => one.values[i])]),
  };
}
