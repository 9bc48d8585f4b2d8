// Holds what all kinds of chart share: text, axes, legend, tooltip.
// SPDX-License-Identifier: Apache-2.0

// Returns about the width of a text in pixels. This is good enough to keep room for labels before anything is drawn.
export const textWidth = (text, size = 12) => (String(text).length * 0.58 + (String(text).match(/[A-Z]/g)?.length ?? 0) * 0.12) * size;

export function base(t) {
  return {
    animation: false,
    textStyle: { fontFamily: t.font, color: t.ink, fontSize: 12 },
    aria: { enabled: false },
    tooltip: {
      backgroundColor: t.page,
      borderColor: t.line,
      borderWidth: 1,
      padding: [6, 10],
      textStyle: { color: t.ink, fontFamily: t.font, fontSize: 12 },
      extraCssText: "box-shadow: 0 2px 10px rgba(0,0,0,.12); font-variant-numeric: tabular-nums;",
      confine: true,
    },
  };
}

export function valueAxis(t, format, name) {
  return {
    type: "value",
    axisLine: { show: false },
    axisTick: { show: false },
    splitLine: { lineStyle: { color: t.line } },
    splitNumber: 4,
    axisLabel: { color: t.muted, fontSize: 11, formatter: format },
    name,
    nameLocation: "middle",
    nameGap: 28,
    nameTextStyle: { color: t.muted, fontSize: 11 },
  };
}

// Labels that `width` has no room for are cut. With `twoLines`, where rows are high enough, what stands behind the last comma goes below.
export function categoryAxis(t, labels, width, twoLines = false) {
  const formatter = (label) => (twoLines && textWidth(label) > width ? label.replace(/, ([^,]*)$/, ",\n$1") : label);
  return {
    type: "category",
    data: labels,
    axisLine: { show: false },
    axisTick: { show: false },
    axisLabel: { color: t.ink, fontSize: 12, lineHeight: 14, width, overflow: "truncate", interval: 0, formatter },
  };
}

// Returns a legend at the top left, and the height of its lines. Symbols have 10 px, with 6 px to the text and 14 px between items.
export function legend(t, names, width) {
  let lines = 1, used = 0;
  for (const name of names) {
    const item = 10 + 6 + textWidth(name) + 14;
    if (used + item > width && used > 0) {
      lines += 1;
      used = 0;
    }
    used += item;
  }
  return {
    height: names.length ? lines * 20 + 8 : 0,
    option: {
      show: names.length > 0,
      type: "plain",
      left: 0,
      top: 0,
      padding: 0,
      itemWidth: 10,
      itemHeight: 10,
      itemGap: 14,
      icon: "rect",
      data: names,
      textStyle: { color: t.muted, fontSize: 12, padding: [0, 0, 0, 0] },
      inactiveColor: t.line,
      selectedMode: true,
    },
  };
}

// Returns a tooltip. Each of its lines has a mark, a name, and a value on the right.
export function tip(title, lines) {
  const rows = lines.map(([colour, name, value]) => `<tr><td style="padding:1px 0">${colour ? `<span style="display:inline-block;width:9px;height:9px;background:${colour};margin-right:6px"></span>` : ""}${escape(name)}</td><td style="text-align:right;padding-left:16px">${value}</td></tr>`);
  return `<div style="font-weight:600;margin-bottom:3px">${escape(title)}</div><table style="border-collapse:collapse">${rows.join("")}</table>`;
}

export const escape = (text) => String(text).replace(/[&<>"]/g, (c) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[c]);
