// Holds the colours: Okabe and Ito's eight, which stay apart for every kind of colour vision, and the inks of both schemes.
// SPDX-License-Identifier: Apache-2.0

const kColours = { blue: "#0072B2", sky: "#56B4E9", green: "#009E73", orange: "#E69F00", red: "#D55E00", pink: "#CC79A7", yellow: "#F0E442", grey: "#8A929C", pale: "#D3D7DC", dark: "#454C55" };
const kSchemes = {
  light: { ink: "#1b2026", muted: "#5c6672", line: "#e4e7eb", page: "#ffffff", colours: kColours },
  dark: {
    ink: "#e8ebef", muted: "#9aa4b0", line: "#2a3038", page: "#14181d",
    colours: { ...kColours, blue: "#2E8FCB", sky: "#7CC7F2", green: "#1DB58A", red: "#E2722A", grey: "#868E98", pale: "#3C434C", dark: "#B4BBC4" },
  },
};
const kFont = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"; // An exported SVG has it in an attribute, unescaped, so its quotes are single.

const kRunColours = ["blue", "orange", "green", "pink", "sky", "red", "yellow", "dark"];
export const kMaxColours = kRunColours.length;
export const runColour = (index) => kRunColours[index % kRunColours.length];

const darkScheme = window.matchMedia("(prefers-color-scheme: dark)");
export const currentScheme = () => (darkScheme.matches ? "dark" : "light");
export const onSchemeChange = (act) => darkScheme.addEventListener("change", act);

export function theme(scheme = currentScheme()) {
  const { colours, ...inks } = kSchemes[scheme];
  return { ...inks, font: kFont, colour: (name) => colours[name] };
}

// Returns black or white, whichever reads better on `hex` (WCAG 2.1, relative luminance).
export function inkOn(hex) {
  const channel = (at) => {
    const c = parseInt(hex.slice(at, at + 2), 16) / 255;
    return c <= 0.04045 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4;
  };
  const luminance = 0.2126 * channel(1) + 0.7152 * channel(3) + 0.0722 * channel(5);
  return luminance > 0.26 ? "#14181d" : "#ffffff";
}
