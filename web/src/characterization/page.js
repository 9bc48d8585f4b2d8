// The page of `glint characterize`: reads the embedded document and puts its sections in order.
// SPDX-License-Identifier: Apache-2.0
import { h } from "../dom.js";
import { figure } from "../figure.js";
import { number, percent } from "../format.js";
import * as dendrogram from "./dendrogram.js";
import * as kiviat from "./kiviat.js";
import * as model from "./model.js";
import * as scatter from "./scatter.js";
import * as scree from "./scree.js";

const data = JSON.parse(document.getElementById("data").textContent);

const figures = (...list) => {
  const drawn = list.map(({ info, make }) => {
    const chart = make(data);
    return chart ? figure({ ...info, note: typeof info.note === "function" ? info.note(data) : info.note }, chart) : null;
  }).filter(Boolean);
  return drawn.length ? h("div", { class: "figures" }, drawn) : null;
};

function section(id, title, lead, ...content) {
  const known = content.flat().filter(Boolean);
  return known.length ? h("section", { id }, h("h2", {}, title), lead ? h("p", { class: "lead" }, lead) : null, known) : null;
}

const keyNumber = (name, value, sub) => h("div", { class: "number" }, h("dt", {}, name), h("dd", {}, value), h("dd", { class: "sub" }, sub));

function overview() {
  const names = data.workloads.filter((one) => one.chosen).map((one) => one.name);
  const { reference } = data;
  return h("section", { id: "overview" },
    h("div", { class: "hero" }, h("p", { class: "kicker" }, "Glint characterisation"), h("h1", {}, `${data.workloads.length} workloads`), h("p", { class: "about" }, data.source)),
    h("div", { class: "key" }, h("dl", { class: "numbers" },
      keyNumber("Metrics", number(data.num_metrics), data.num_dropped ? `${data.num_dropped} columns left out: below` : "every column that varies"),
      keyNumber("Components", number(data.kept), `eigenvalue above 1; ${percent(data.explained)} of the variance`),
      keyNumber("Clusters", number(data.clusters), `${data.linkage} linkage; tree and distances correlate by ${data.cophenetic.toFixed(3)}`),
      keyNumber("Representative metrics", number(data.axes.length), `distances in them correlate by ${data.fitness.toFixed(4)} with those in all`))),
    h("p", { class: "note" }, `Representative subset: ${names.join(", ")}. Mean distance of a workload to the nearest of them: ${percent(data.coverage_error)} of that between two workloads.`),
    reference.known ? h("p", { class: "note" }, `${reference.name[0].toUpperCase()}${reference.name.slice(1)}: in ${reference.clusters_met} of ${data.clusters} clusters, ${percent(reference.coverage_error)}.`) : null);
}

const sections = [
  overview(),
  section("components", "Principal components", "Directions in which the workloads differ most, of all metrics standardised: independent of each other, the first with most of the variance.", figures(scree, scatter.first, scatter.second)),
  section("clusters", "Clusters", "Workloads that are near each other in these components join first; a branch ends where its two groups are that far apart.", figures(dendrogram)),
  section("kiviat", "Kiviat diagrams", "The metrics that tell the workloads apart best, each from the least of all workloads in the centre to the most at the rim.", kiviat.key(data), figures(kiviat)),
  section("models", "Analytical models", "Cycles that models predict, against those of the simulated machine. Inputs: models.csv.", figures(model.scatter, model.errors)),
];
document.getElementById("figures").append(...sections.filter(Boolean));
document.getElementById("contents").append(h("a", { href: "#overview", class: "brand" }, "Glint"), ...[...document.querySelectorAll("section > h2")].map((title) => h("a", { href: `#${title.parentElement.id}` }, title.textContent)));
document.getElementById("footer").append(`Glint ${data.version}.`);
document.documentElement.dataset.ready = "yes"; // for tests: all of the above has run
