# Values that the characterisation is checked against, by numpy, SciPy and scikit-learn.
# SPDX-License-Identifier: Apache-2.0
"""usage: reference.py data/metrics.csv > data/expected.json

Needs Debian's python3-scipy and python3-sklearn; the test itself needs only what this has written. Which columns take part is decided
here anew: those with a number in every row that vary, less what names the run, the host's speed and repeated columns."""
import csv
import itertools
import json
import sys

import numpy
import scipy
import sklearn
from scipy.cluster import hierarchy
from scipy.spatial.distance import pdist
from sklearn.decomposition import PCA
from sklearn.preprocessing import StandardScaler

NOT_METRICS = {"workload", "scene", "form", "shader", "config", "config_hash", "fraction", "width", "height", "samples", "sim_rate"}
CLUSTERS = 8
SMALL = 10  # columns of the case whose best sets of three are all tried


def columns_of(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    names, values = [], []
    for name in rows[0]:
        cells = [row[name] for row in rows]
        if name in NOT_METRICS or "" in cells:
            continue
        column = [float(cell) for cell in cells]
        if len(set(column)) > 1 and column not in values:
            names.append(name)
            values.append(column)
    return names, numpy.array(values).T


def fitness(standardised, full, columns):
    return float(numpy.corrcoef(pdist(standardised[:, list(columns)]), full)[0, 1])


def main():
    names, values = columns_of(sys.argv[1])
    standardised = StandardScaler().fit_transform(values)
    pca = PCA(svd_solver="full").fit(standardised)
    eigenvalues = pca.explained_variance_ * (len(values) - 1) / len(values)  # scikit-learn divides by n - 1
    kept = int((eigenvalues > 1).sum())
    scores = pca.transform(standardised)[:, :kept]
    directions = pca.components_[:kept].T
    signs = numpy.sign(directions[numpy.abs(directions).argmax(axis=0), range(kept)])
    trees = {}
    for method in ("single", "complete", "average", "ward"):
        tree = hierarchy.linkage(scores, method)
        trees[method] = {"linkage": tree.tolist(), "leaves": hierarchy.leaves_list(tree).tolist(),
                         "clusters": hierarchy.fcluster(tree, CLUSTERS, "maxclust").tolist(),
                         "cophenetic": float(hierarchy.cophenet(tree, pdist(scores))[0])}
    small = standardised[:, :SMALL]
    sets = sorted(((fitness(small, pdist(small), chosen), chosen) for chosen in itertools.combinations(range(SMALL), 3)), reverse=True)
    json.dump({"made_by": f"numpy {numpy.__version__}, SciPy {scipy.__version__}, scikit-learn {sklearn.__version__}",
               "metrics": names, "eigenvalues": eigenvalues.tolist(), "kept": kept, "scores": (scores * signs).tolist(),
               "loadings": (directions * signs * numpy.sqrt(eigenvalues[:kept])).tolist(), "trees": trees,
               "fitness_of_first_eight": fitness(standardised, pdist(standardised), range(8)),
               "small": {"columns": SMALL, "best": list(sets[0][1]), "fitness": sets[0][0], "second": sets[1][0]}},
              sys.stdout)
    print()


main()
