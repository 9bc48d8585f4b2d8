// Draws bars over time with a row for each track: who did what and when.
// SPDX-License-Identifier: Apache-2.0
import { number, short } from "../format.js";
import { base, legend, textWidth, tip, valueAxis } from "./common.js";

const kRow = 15, kStrip = 3, kGap = 2;

// `tracks` are names, from the top. `groups` are {name, colour, bars: [{track, begin, length, title, lines: [[name, value]], strip, apart}]}. A strip
// is a thin bar above the others of its track; bars that are `apart` have a gap between them.
export function gantt({ tracks, groups, begin, end, unit }) {
  const shown = groups.filter((group) => group.bars.length);
  const names = shown.map((group) => group.name);

  function option(t, width) {
    const top = legend(t, names, width);
    const left = Math.max(...tracks.map((track) => textWidth(track, 11))) + 10;
    const draw = (group) => (params, api) => {
      const bar = group.bars[params.dataIndex];
      const [x, y] = api.coord([bar.begin, bar.track]), [to] = api.coord([bar.begin + bar.length, bar.track]);
      const height = bar.strip ? kStrip : kRow - kStrip - kGap, from = bar.strip ? y - kRow / 2 + kGap / 2 : y - kRow / 2 + kGap / 2 + kStrip;
      return { type: "rect", shape: { x, y: from, width: Math.max(to - x, 0.4), height }, style: { fill: t.colour(group.colour), ...(bar.apart ? { stroke: t.page, lineWidth: 1 } : {}) } };
    };
    return {
      ...base(t),
      legend: top.option,
      grid: { left, right: 16, top: top.height + 4, height: tracks.length * kRow },
      xAxis: { ...valueAxis(t, (value) => (value === begin || value === end ? "" : short(value)), unit), min: begin, max: end, splitNumber: 8, axisLine: { show: true, lineStyle: { color: t.line } } },
      yAxis: {
        type: "category", data: tracks, inverse: true, axisLine: { show: false }, axisTick: { show: false },
        axisLabel: { color: t.muted, fontSize: 11, interval: tracks.length > 40 ? "auto" : 0 }, splitLine: { show: false },
      },
      tooltip: {
        ...base(t).tooltip,
        trigger: "item",
        formatter: ({ seriesIndex, dataIndex }) => {
          const bar = shown[seriesIndex].bars[dataIndex];
          return tip(`${tracks[bar.track]}: ${bar.title}`, [[t.colour(shown[seriesIndex].colour), "cycles", number(bar.length)], ["", "from", number(bar.begin)], ["", "to", number(bar.begin + bar.length)], ...bar.lines.map(([name, value]) => ["", name, number(value)])]);
        },
      },
      series: shown.map((group) => ({
        type: "custom",
        name: group.name,
        color: t.colour(group.colour),
        renderItem: draw(group),
        encode: { x: [0, 1], y: 2 },
        data: group.bars.map((bar) => [bar.begin, bar.begin + bar.length, bar.track]),
      })),
    };
  }
  return { option, height: (t, width) => legend(t, names, width).height + tracks.length * kRow + 52 };
}
