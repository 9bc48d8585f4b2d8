# Tests the shape of the scenes' trees: nodes a ray, depth and triangles beside what others published of LumiBench.
# SPDX-License-Identifier: Apache-2.0
"""usage: published_test.py GLINT SOURCE_DIR"""
import csv
import json
import subprocess

from glint_case import ROOT, GlintTest, main

DEPTH_WITHIN, TRIANGLES_WITHIN = 1, 0.04


def table():
    lines = (ROOT / "tests/cli/published.csv").read_text().splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


class Published(GlintTest):
    def assets(self, name):
        """Returns the options that read the original files, or None where they are not there."""
        if not name:
            return []
        archive = ROOT.parent / "shared/data/scenes" / f"{name}.tar.zst"
        if not archive.exists():
            print(f"SKIPPED: {archive.name} is not there, so its nodes a ray are not compared with the published ones")
            return None
        subprocess.run(["tar", "--zstd", "-xf", archive, "-C", self.folder], check=True)
        return ["--assets", self.folder]

    def test_nodes_a_ray_depth_and_triangles_are_near_the_published_ones(self):
        for row in table():
            assets = self.assets(row["data"])
            if assets is None:
                continue
            with self.subTest(scene=row["scene"]):
                done = self.glint("run", row["scene"], "--config", "vulkan-sim-mobile", "--size", row["size"], "--spp", 1, "--stats", "compact",
                                  "--out", "run/" + row["scene"], *assets)
                self.assertEqual(done.returncode, 0, done.stderr)
                with open(self.folder / "run" / row["scene"] / "stats.csv", newline="") as file:
                    stats = {line[0].rpartition(".")[2]: line[1] for line in csv.reader(file) if ".rt." in line[0]}
                run = json.loads((self.folder / "run" / row["scene"] / "run.json").read_text())
                nodes, published = float(stats["nodes"]) / float(stats["rays"]), float(row["nodes"])
                self.assertLessEqual(abs(nodes / published - 1), float(row["within"]), f"{nodes:.2f} nodes a ray, published {published}")
                # The published depth counts a level for the leaves.
                depth = run["structures"]["top_depth"] + run["structures"]["bottom_depth"] + 1
                self.assertLessEqual(abs(depth - int(row["depth"])), DEPTH_WITHIN, f"{depth} levels, published {row['depth']}")
                self.assertAlmostEqual(run["scene"]["triangles"], int(row["triangles"]), delta=TRIANGLES_WITHIN * int(row["triangles"]))


main()
