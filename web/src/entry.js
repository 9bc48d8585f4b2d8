// What the script of a page starts with: which page it is.
// SPDX-License-Identifier: Apache-2.0

// The bundle holds both; only the one that is asked for runs.
if (JSON.parse(document.getElementById("data").textContent).kind === "characterization") import("./characterization/page.js");
else import("./main.js");
