// Writes numbers as people read them: narrow spaces between thousands, a true minus, units apart.
// SPDX-License-Identifier: Apache-2.0

const kThin = "\u202f";

function grouped(digits) {
  return digits.replace(/\B(?=(\d{3})+(?!\d))/g, kThin);
}

// Writes whole numbers in full, and others with four significant digits.
export function number(value) {
  if (value === null || value === undefined || Number.isNaN(value)) return "–";
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  const sign = value < 0 ? "−" : "";
  if (Number.isInteger(value)) return sign + grouped(String(size));
  if (size >= 1000) return sign + grouped(size.toFixed(0));
  return sign + (size >= 0.001 ? String(Number(size.toPrecision(4))) : size.toPrecision(3));
}

export function percent(fraction, digits = 1) {
  return fraction === null || !Number.isFinite(fraction) ? "–" : `${(100 * fraction).toFixed(digits)}${kThin}%`;
}

// Writes a change as a share of what was: +3.2 %, −12 %.
export function change(ratio) {
  if (ratio === null || !Number.isFinite(ratio)) return "–";
  const share = 100 * (ratio - 1);
  if (share === 0) return "0" + kThin + "%";
  const size = Math.abs(share);
  const digits = size >= 100 ? 0 : size >= 10 ? 1 : 2;
  return `${share < 0 ? "−" : "+"}${grouped(size.toFixed(digits))}${kThin}%`;
}

const kPrefixes = [[1e12, "T"], [1e9, "G"], [1e6, "M"], [1e3, "k"], [1, ""]];

// Writes three significant digits: 208 M, 3.42 G.
export function short(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  const [scale, prefix] = kPrefixes.find(([limit]) => Math.abs(value) >= limit) ?? [1, ""];
  const text = String(Number((value / scale).toPrecision(3)));
  return prefix ? text + kThin + prefix : text;
}

export function bytes(value) {
  if (value === null || !Number.isFinite(value)) return "–";
  for (const [scale, unit] of [[2 ** 30, "GiB"], [2 ** 20, "MiB"], [2 ** 10, "KiB"]])
    if (value >= scale) return `${Number((value / scale).toPrecision(3))}${kThin}${unit}`;
  return `${value}${kThin}B`;
}

// Writes seconds of the simulated machine or of the host.
export function duration(seconds) {
  if (seconds === null || !Number.isFinite(seconds)) return "–";
  for (const [scale, unit] of [[60, "min"], [1, "s"], [1e-3, "ms"], [1e-6, "µs"]])
    if (seconds >= scale) return `${Number((seconds / scale).toPrecision(3))}${kThin}${unit}`;
  return `${Number((seconds * 1e9).toPrecision(3))}${kThin}ns`;
}
