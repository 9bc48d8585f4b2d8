// Draws what analytical models predict against what was simulated (LumiBench, Figure 15), and how far they are off.
// SPDX-License-Identifier: Apache-2.0
import { number, percent, short } from "../format.js";
import { bars } from "../kinds/bars.js";
import { base, legend, tip, valueAxis } from "../kinds/common.js";

const kLeastForR2 = 3; // a line through two points always fits
const kHeight = 460, kColours = ["orange", "blue", "green", "pink"];

function points(data) {
  const { models, workloads } = data;
  const all = workloads.flatMap((one) => [one.cycles, ...one.predicted]);
  const low = 10 ** Math.floor(Math.log10(Math.min(...all))), high = 10 ** Math.ceil(Math.log10(Math.max(...all)));
  const axis = (t, name) => ({ ...valueAxis(t, short), type: "log", min: low, max: high, name });
  const option = (t, width) => {
    const top = legend(t, models.map((one) => one.name), width);
    return {
      ...base(t),
      legend: top.option,
      grid: { left: 60, right: 14, top: top.height + 4, bottom: 46 },
      xAxis: axis(t, "simulated cycles"),
      yAxis: { ...axis(t, "predicted cycles"), nameGap: 46 },
      tooltip: { ...base(t).tooltip, formatter: ({ seriesIndex, dataIndex }) => (seriesIndex < models.length ? tip(workloads[dataIndex].name, [[null, "simulated", number(workloads[dataIndex].cycles)], ...models.map((one, i) => [t.colour(kColours[i]), one.name, `${number(Math.round(workloads[dataIndex].predicted[i]))} (${percent(workloads[dataIndex].predicted[i] / workloads[dataIndex].cycles - 1, 0)})`])]) : "") },
      series: [
        ...models.map((one, i) => ({ type: "scatter", name: one.name, symbolSize: 8, color: t.colour(kColours[i]), itemStyle: { opacity: 0.85 }, emphasis: { disabled: true }, data: workloads.map((each) => [each.cycles, each.predicted[i]]) })),
        { type: "line", symbol: "none", silent: true, lineStyle: { color: t.muted, width: 1, type: "dashed" }, data: [[low, low], [high, high]] },
      ],
    };
  };
  return { option, height: () => kHeight, columns: ["workload", "simulated cycles", ...models.map((one) => `${one.name}: cycles`)], rows: workloads.map((one) => [one.name, one.cycles, ...one.predicted]) };
}

export const scatter = {
  info: { id: "model-cycles", wide: true, title: "Predicted and simulated cycles", note: (data) => `${data.models.map((one) => `${one.name} has ${data.workloads.length < kLeastForR2 ? "" : `an R² of ${one.r2.toFixed(3)} and `}a mean error of ${percent(one.mape)}`).join("; ")}. On the dashed line both are equal.` },
  make: points,
};

export const errors = {
  info: { id: "model-errors", wide: true, title: "Error of each workload", note: "Each value is the size of the difference, as a share of the simulated cycles." },
  make: ({ models, workloads }) => bars({ rows: workloads.map((one) => one.name), series: models.map((one, i) => ({ name: one.name, colour: kColours[i], values: workloads.map((each) => Math.abs(each.predicted[i] / each.cycles - 1)) })), format: (value) => percent(value, 0) }),
};
