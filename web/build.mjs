// Builds dist/: one script with the charts and their licences, the style and the page's frame.
// SPDX-License-Identifier: Apache-2.0
import { build } from "esbuild";
import { copyFileSync, readFileSync } from "node:fs";

const read = (path) => readFileSync(new URL(path, import.meta.url), "utf8");
const version = (name) => JSON.parse(read(`node_modules/${name}/package.json`)).version;

// Both licences ask for their notices in every copy, and a report is a copy.
const banner = `/*!
Glint report. SPDX-License-Identifier: Apache-2.0

Contains Apache ECharts ${version("echarts")} (Apache License 2.0, https://www.apache.org/licenses/LICENSE-2.0):
${read("node_modules/echarts/NOTICE").trim()}

Contains ZRender ${version("zrender")} (BSD 3-Clause):
${read("node_modules/zrender/LICENSE").trim()}

Contains parts of d3 (BSD 3-Clause), as ECharts says:
${read("node_modules/echarts/licenses/LICENSE-d3").trim()}

Contains tslib ${version("tslib")} (0BSD): Copyright (c) Microsoft Corporation.
*/`;

const options = { bundle: true, minify: true, format: "iife", target: "es2020", charset: "utf8", legalComments: "none" }; // the banner has them
await build({ ...options, entryPoints: ["src/main.js"], outfile: "dist/report.js", banner: { js: banner } });
await build({ ...options, entryPoints: ["src/unpack.js"], outfile: "dist/unpack.js" });
for (const name of ["report.html", "report.css"]) copyFileSync(`src/${name}`, `dist/${name}`);
