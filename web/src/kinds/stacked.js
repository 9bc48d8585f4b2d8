// Draws horizontal bars of parts that make up a whole: shares within a bar, amounts in the table.
// SPDX-License-Identifier: Apache-2.0
import { number, percent, short } from "../format.js";
import { inkOn } from "../theme.js";
import { base, categoryAxis, legend, textWidth, tip, valueAxis } from "./common.js";

const kRow = 34, kBar = 22;

// `rows` are labels. `parts` are {name, colour, values: one for each row}. `whole` has one for each row; without it, a whole is the sum of the parts.
// `scale` says for each row what a whole bar is (2.3 cycles per instruction). Bars are then as long as that, and not all of 100 %.
export function stacked({ rows, parts, unit, whole, scale, scaleName, scaleFormat = number }) {
  const sums = whole ?? rows.map((_, i) => parts.reduce((sum, part) => sum + (part.values[i] ?? 0), 0));
  const shown = parts.filter((part) => part.values.some((value) => value > 0));
  const share = (part, i) => (sums[i] ? (part.values[i] ?? 0) / sums[i] : 0);
  const length = (part, i) => share(part, i) * (scale ? scale[i] : 1);
  const longest = scale ? Math.max(...scale) : 1;

  function option(t, width) {
    const left = rows.length > 1 || rows[0] ? Math.min(Math.max(...rows.map((row) => textWidth(row))) + 18, width * 0.4) : 0;
    const top = legend(t, shown.map((part) => part.name), width);
    const plot = width - left - 12;
    const wide = (value) => (value / longest) * plot > 44;
    return {
      ...base(t),
      legend: top.option,
      grid: { left, right: 12, top: top.height, bottom: scaleName ? 44 : 24 },
      xAxis: { ...valueAxis(t, (value) => (scale ? scaleFormat(value) : `${Math.round(100 * value)} %`), scaleName), min: 0, ...(scale ? {} : { max: 1, interval: 0.25 }) },
      yAxis: { ...categoryAxis(t, rows, left - 8, true), inverse: true },
      tooltip: {
        ...base(t).tooltip,
        trigger: "axis",
        axisPointer: { type: "none" },
        formatter: (items) => {
          const i = items[0].dataIndex;
          const lines = shown.filter((part) => part.values[i] > 0).map((part) => [t.colour(part.colour), part.name, `${short(part.values[i])} &nbsp; ${percent(share(part, i))}`]);
          return tip(rows[i] || unit, [...lines, ["", `all (${unit})`, short(sums[i])]]);
        },
      },
      series: shown.map((part) => ({
        type: "bar",
        name: part.name,
        stack: "all",
        barWidth: kBar,
        color: t.colour(part.colour),
        itemStyle: { borderColor: t.page, borderWidth: 1 },
        label: {
          show: true,
          position: "inside",
          fontSize: 11,
          color: inkOn(t.colour(part.colour)),
          formatter: ({ dataIndex: i }) => (wide(length(part, i)) ? percent(share(part, i)) : ""),
        },
        emphasis: { disabled: true },
        data: rows.map((_, i) => length(part, i)),
      })),
    };
  }
  return {
    option,
    height: (t, width) => legend(t, shown.map((part) => part.name), width).height + rows.length * kRow + (scaleName ? 48 : 28),
    columns: ["", ...parts.map((part) => `${part.name} (${unit})`), `all (${unit})`],
    rows: rows.map((row, i) => [row || "all", ...parts.map((part) => part.values[i]), sums[i]]),
  };
}
