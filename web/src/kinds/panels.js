// Draws horizontal bars of parts for several measures of the same rows, in panels beside each other, or below each other where it is narrow.
// SPDX-License-Identifier: Apache-2.0
import { percent, short } from "../format.js";
import { inkOn } from "../theme.js";
import { base, categoryAxis, legend, textWidth, tip, valueAxis } from "./common.js";

const kRow = 34, kBar = 22, kTitle = 24, kAxis = 28, kGap = 16;
const kBelow = 12;   // between panels below each other
const kNarrow = 560; // pixels; two panels need more
const kEnd = 46;     // room for the share at a bar's end

// `rows` are labels. `parts` are {name, colour}. `panels` are {name, unit, values: [part][row], wholes: one for each row}. A bar is as long as its
// part of the whole.
export function panels({ rows, parts, panels: list }) {
  const sum = (panel, i) => panel.values.reduce((all, values) => all + (values[i] ?? 0), 0);
  const share = (panel, value, i) => (panel.wholes[i] ? (value ?? 0) / panel.wholes[i] : 0);
  const shown = parts.map((part, p) => ({ ...part, p })).filter(({ p }) => list.some((panel) => panel.values[p].some((value) => value > 0)));
  const longest = Math.max(...list.flatMap((panel) => rows.map((_, i) => share(panel, sum(panel, i), i))));
  const step = longest > 0.6 ? 0.2 : longest > 0.25 ? 0.1 : 0.05, end = Math.min(1, step * Math.ceil(longest / step - 1e-9));
  const names = shown.map((part) => part.name);
  const isNarrow = (width) => list.length > 1 && width < kNarrow;

  function places(t, width) {
    const left = Math.min(Math.max(...rows.map((row) => textWidth(row))) + 18, width * 0.4);
    const top = legend(t, names, width).height, plot = rows.length * kRow;
    if (isNarrow(width)) return list.map((_, k) => ({ left, top: top + kTitle + k * (plot + kTitle + kAxis + kBelow), width: width - left - kEnd, height: plot }));
    const each = (width - left - kGap * (list.length - 1)) / list.length;
    return list.map((_, k) => ({ left: left + k * (each + kGap), top: top + kTitle, width: each - kEnd, height: plot }));
  }

  // Returns the parts of a panel, and a bar of no length whose end says what all of them are.
  function bars(t, panel, k, plot) {
    const common = { type: "bar", stack: `panel ${k}`, xAxisIndex: k, yAxisIndex: k, barWidth: kBar, emphasis: { disabled: true } };
    const isWide = (value, i) => (share(panel, value, i) / end) * plot.width > 44;
    const drawn = shown.map((part) => ({
      ...common,
      name: part.name,
      color: t.colour(part.colour),
      itemStyle: { borderColor: t.page, borderWidth: 1 },
      label: { show: true, position: "inside", fontSize: 11, color: inkOn(t.colour(part.colour)), formatter: ({ dataIndex: i }) => (isWide(panel.values[part.p][i], i) ? percent(share(panel, panel.values[part.p][i], i)) : "") },
      data: rows.map((_, i) => share(panel, panel.values[part.p][i], i)),
    }));
    const whole = { ...common, name: "", silent: true, color: "transparent", label: { show: true, position: "right", fontSize: 11, color: t.ink, formatter: ({ dataIndex: i }) => percent(share(panel, sum(panel, i), i)) }, data: rows.map(() => 0) };
    return [...drawn, whole];
  }

  function tooltip(t, items) {
    const { axisIndex: k, dataIndex: i } = items[0], panel = list[k];
    const lines = shown.filter(({ p }) => panel.values[p][i] > 0).map((part) => [t.colour(part.colour), part.name, `${short(panel.values[part.p][i])} &nbsp; ${percent(share(panel, panel.values[part.p][i], i))}`]);
    return tip(`${rows[i]}, ${panel.name}`, [...lines, ["", `all (${panel.unit})`, `${short(sum(panel, i))} &nbsp; ${percent(share(panel, sum(panel, i), i))}`]]);
  }

  function option(t, width) {
    const all = places(t, width);
    return {
      ...base(t),
      legend: legend(t, names, width).option,
      title: list.map((panel, k) => ({ text: panel.name, left: all[k].left, top: all[k].top - kTitle + 2, padding: 0, textStyle: { color: t.ink, fontSize: 12, fontWeight: 600, fontFamily: t.font } })),
      grid: all,
      xAxis: list.map((_, k) => ({ ...valueAxis(t, (value) => percent(value, 0)), gridIndex: k, min: 0, max: end, interval: step })),
      yAxis: list.map((_, k) => {
        const axis = { ...categoryAxis(t, rows, all[0].left - 8, true), gridIndex: k, inverse: true };
        return k && !isNarrow(width) ? { ...axis, axisLabel: { show: false } } : axis;
      }),
      tooltip: { ...base(t).tooltip, trigger: "axis", axisPointer: { type: "none" }, formatter: (items) => tooltip(t, items) },
      series: list.flatMap((panel, k) => bars(t, panel, k, all[k])),
    };
  }

  return {
    option,
    height: (t, width) => Math.max(...places(t, width).map((place) => place.top + place.height)) + kAxis,
    columns: ["", ...list.flatMap((panel) => [...parts.map((part) => `${part.name} (${panel.unit})`), `all (${panel.unit})`])],
    rows: rows.map((row, i) => [row, ...list.flatMap((panel) => [...panel.values.map((values) => values[i] ?? 0), sum(panel, i)])]),
  };
}
