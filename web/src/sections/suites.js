// Shows characterisations and models of whole suites, and experiments. Their figures go into the sections that the page brings along with their tables.
// SPDX-License-Identifier: Apache-2.0
import * as dendrogram from "../characterization/dendrogram.js";
import * as kiviat from "../characterization/kiviat.js";
import * as model from "../characterization/model.js";
import * as scatter from "../characterization/scatter.js";
import * as scree from "../characterization/scree.js";
import { h } from "../dom.js";
import { figures } from "../figure.js";
import { number, percent } from "../format.js";
import * as speedups from "../lab/speedups.js";

const keyNumber = (name, value, sub) => h("div", { class: "number" }, h("dt", {}, name), h("dd", { "data-value": value }, number(value)), h("dd", { class: "sub" }, sub));

function characterization(data, suffix) {
  const dropped = data.dropped.length;
  return [
    h("div", { class: "key" }, h("dl", { class: "numbers" },
      keyNumber("Metrics", data.loadings.length, dropped ? `${dropped} columns left out: below` : "every column that varies"),
      keyNumber("Components", data.kept, `eigenvalue above 1; ${percent(data.explained)} of the variance`),
      keyNumber("Clusters", data.clusters, `${data.linkage} linkage; tree and distances correlate by ${data.cophenetic.toFixed(3)}`),
      keyNumber("Representative metrics", data.axes.length, `distances in them correlate by ${data.fitness.toFixed(4)} with those in all`))),
    figures([scree, scatter.first, scatter.second, dendrogram, kiviat], data, suffix),
  ];
}

const lab = (data, suffix) => [figures([speedups.means, speedups.workloads], data, suffix)];

const models = (data, suffix) => [figures([model.scatter, model.errors], data, suffix)];

// The documents of `list` belong to the sections `id`, `id`-2, ... in this order. One that was not computed has only a line there.
function fill(list, id, make) {
  (list ?? []).forEach((data, i) => {
    const suffix = i ? `-${i + 1}` : "";
    if (!data.missing) document.getElementById(id + suffix).querySelector(".drawn").append(...make(data, suffix).filter(Boolean));
  });
}

export function suites(data) {
  fill(data.characterizations, "characterization", characterization);
  fill(data.models, "models", models);
  fill(data.labs, "lab", lab);
}
