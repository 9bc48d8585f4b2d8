# Tests sequences of frames: scenes that move, glTF animations, camera paths, structures that are fitted, and the files that are left.
# SPDX-License-Identifier: Apache-2.0
"""usage: frames_test.py GLINT SOURCE_DIR [SUITE...]"""
import base64
import csv
import itertools
import json
import math
import re
import struct
import sys
import unittest
import zlib

from glint_case import GlintTest, read_png

SMALL = ["--size", "32x32", "--spp", "1"]
FAST = [*SMALL, "--mode", "functional"]
TURN = 0.5 ** 0.5  # the quaternion (0, 0, TURN, TURN) turns by 90 degrees about z


def chunks(data):
    """Returns the type and data of each chunk of a PNG, whose checks must be right."""
    out, at = [], 8
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        assert struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0] == zlib.crc32(kind + body)
        out.append((kind, body))
        at += 12 + size
    return out


class GltfFile:
    """Builds a glTF file: one glowing square of edge 1 in x and y around the origin, and a camera at z = 4 that sees x and y from about -1.45 to 1.45."""

    def __init__(self):
        self.data, self.views, self.accessors = b"", [], []
        corners = [(-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)]
        self.primitive = {"attributes": {"POSITION": self.floats(corners, "VEC3")}, "indices": self.shorts([0, 1, 2, 0, 2, 3]), "material": 0}
        self.mesh = {"primitives": [self.primitive]}
        self.nodes = [{"mesh": 0}, {"camera": 0, "translation": [0, 0, 4]}]
        self.more, self.channels, self.samplers = {}, [], []

    def view(self, data, **more):
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data)})
        self.data += data + bytes(-len(data) % 4)
        self.accessors.append({"bufferView": len(self.views) - 1, **more})
        return len(self.accessors) - 1

    def floats(self, rows, kind):
        flat = list(itertools.chain(*rows)) if kind != "SCALAR" else list(rows)
        count = len(rows)
        bounds = {"min": [min(c) for c in zip(*rows)], "max": [max(c) for c in zip(*rows)]} if kind == "VEC3" and all(map(math.isfinite, flat)) else {}
        return self.view(struct.pack(f"<{len(flat)}f", *flat), componentType=5126, count=count, type=kind, **bounds)

    def shorts(self, values):
        return self.view(struct.pack(f"<{len(values)}H", *values), componentType=5123, count=len(values), type="SCALAR")

    def bytes(self, rows):
        return self.view(bytes(itertools.chain(*rows)), componentType=5121, count=len(rows), type="VEC4")

    def move(self, path, times, values, interpolation="LINEAR", node=0):
        kind = {"translation": "VEC3", "scale": "VEC3", "rotation": "VEC4", "weights": "SCALAR"}[path]
        self.samplers.append({"input": self.floats(times, "SCALAR"), "output": self.floats(values, kind), "interpolation": interpolation})
        self.channels.append({"sampler": len(self.samplers) - 1, "target": {"node": node, "path": path}})
        return self

    def text(self):
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.data).decode()
        file = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}], "nodes": self.nodes, "meshes": [self.mesh],
                "materials": [{"emissiveFactor": [1, 0, 0], "doubleSided": True}],
                "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
                "buffers": [{"byteLength": len(self.data), "uri": uri}], "bufferViews": self.views, "accessors": self.accessors}
        if self.channels:
            file["animations"] = [{"name": "walk", "channels": self.channels, "samplers": self.samplers}]
        return json.dumps({**file, **self.more})


class FramesCase(GlintTest):
    def run_frames(self, what, frames, *more, out="out"):
        done = self.glint("run", what, "--frames", frames, "--out", out, *more)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def bytes_of(self, name):
        return (self.folder / name).read_bytes()

    def table(self, out="out"):
        with (self.folder / out / "frames.csv").open(newline="") as file:
            return [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]

    def lit(self, name):
        """Returns the box (left, top, right, bottom) of the pixels of a picture that glow."""
        width, height, data = read_png(self.folder / name)
        found = [(i % width, i // width) for i in range(width * height) if data[3 * i] > 100]
        if not found:
            return None
        return (min(x for x, _ in found), min(y for _, y in found), max(x for x, _ in found), max(y for _, y in found))


    def assert_lit(self, boxes, expected):
        """Checks boxes of pixels, whose edges may be a pixel off: the sample of a pixel is somewhere in it."""
        self.assertEqual(len(boxes), len(expected))
        for box, wanted in zip(boxes, expected):
            self.assertEqual(box is None, wanted is None, (boxes, expected))
            self.assertTrue(box is None or all(abs(a - b) <= 1 for a, b in zip(box, wanted)), (boxes, expected))


class Frames(FramesCase):
    def test_a_sequence_leaves_a_run_directory_a_frame_their_sum_and_an_animation(self):
        self.run_frames("WKND", "3:5", *FAST)
        run = json.loads(self.bytes_of("out/run.json"))
        self.assertEqual(run["frames"], ["frame-0003", "frame-0004", "frame-0005"])
        self.assertEqual(run["sequence"], {"first": 3, "last": 5, "fps": 24.0, "structures": "rebuild", "caches": "warm"})
        whole = self.statistics("out")
        parts = [self.statistics(f"out/{name}") for name in run["frames"]]
        for path in ("gpu.rays", "gpu.nodes", "gpu.structures.bottom_levels.built"):
            self.assertEqual(whole[path], sum(part[path] for part in parts), path)
        self.assertAlmostEqual(whole["gpu.structures.expected_visits"], sum(part["gpu.structures.expected_visits"] for part in parts) / 3)
        for number, name in zip((3, 4, 5), run["frames"]):
            own = json.loads(self.bytes_of(f"out/{name}/run.json"))
            self.assertEqual(own["moment"], {"frame": number, "seconds": number / 24})
            self.assertEqual(self.bytes_of(f"out/{name}/image.png"), self.bytes_of(f"out/image-{number:04}.png"))
        self.assertEqual([row["frame"] for row in self.table()], [3, 4, 5])
        self.assertEqual(self.table()[1]["nodes"], parts[1]["gpu.nodes"])

    def test_the_animation_holds_the_pictures_in_order(self):
        self.run_frames("WKND", "0:2", *FAST, "--fps", "12.5")
        pictures = [chunks(self.bytes_of(f"out/image-000{i}.png")) for i in range(3)]
        animation = chunks(self.bytes_of("out/animation.png"))
        self.assertEqual([kind for kind, _ in animation], [b"IHDR", b"acTL", b"fcTL", b"IDAT", b"fcTL", b"fdAT", b"fcTL", b"fdAT", b"IEND"])
        self.assertEqual(animation[1][1], struct.pack(">II", 3, 0))
        data = [animation[3][1], animation[5][1][4:], animation[7][1][4:]]
        for picture, own in zip(pictures, data):
            self.assertEqual(b"".join(body for kind, body in picture if kind == b"IDAT"), own)
        controls = [body for kind, body in animation if kind == b"fcTL"]
        numbers = [struct.unpack(">I", body[:4])[0] for kind, body in animation if kind in (b"fcTL", b"fdAT")]
        self.assertEqual(numbers, [0, 1, 2, 3, 4])
        for control in controls:
            self.assertEqual(struct.unpack(">4I2H2B", control[4:]), (32, 32, 0, 0, 80, 1000, 0, 0))

    def test_a_frame_of_a_sequence_has_the_picture_that_it_has_alone_however_structures_are_updated(self):
        for scene in ("WKND", "BUNNY", "SPNZA"):
            self.run_frames(scene, "0:4", *FAST, "--fps", "5", out="all")
            self.run_frames(scene, "0:4", *FAST, "--fps", "5", "--structures", "refit", "--threads", "2", out="refit")
            self.run_frames(scene, "0:4", *FAST, "--fps", "5", "--structures", "refit-bottom", out="mixed")
            self.run_frames(scene, "3", *FAST, "--fps", "5", out="one")
            alone = self.bytes_of("one/frame-0003/image.pfm")
            for out in ("all", "refit", "mixed"):
                self.assertEqual(self.bytes_of(f"{out}/frame-0003/image.pfm"), alone, (scene, out))
            self.assertNotEqual(self.bytes_of("all/frame-0000/image.pfm"), alone)

    def test_the_first_frame_of_a_scene_is_its_still_picture(self):
        self.run_frames("WKND", "0:0", *FAST)
        self.assertEqual(self.glint("run", "WKND", *FAST, "--out", "still").returncode, 0)
        self.assertEqual(self.bytes_of("out/frame-0000/image.pfm"), self.bytes_of("still/image.pfm"))

    def test_fitted_structures_are_counted_and_cost_more_the_longer_they_are_kept(self):
        self.run_frames("WKND", "0:6", *FAST, "--fps", "4", "--structures", "refit")
        rows = self.table()
        self.assertEqual((rows[0]["bottom_levels_built"], rows[0]["top_levels_built"]), (487, 1))
        for row in rows[1:]:
            self.assertEqual((row["bottom_levels_built"], row["bottom_levels_refitted"]), (0, 483))
            self.assertEqual((row["top_levels_built"], row["top_levels_refitted"]), (0, 1))
        self.assertEqual(rows[0]["expected_visits"], rows[0]["expected_visits_rebuilt"])
        for row in rows[1:]:  # little, because the ground's box is as large as the scene's
            self.assertGreater(row["expected_visits"], row["expected_visits_rebuilt"])
        self.run_frames("WKND", "0:6", *FAST, "--fps", "4", out="anew")
        anew = self.table("anew")
        for fitted, built in zip(rows, anew):
            self.assertEqual(fitted["expected_visits_rebuilt"], built["expected_visits"])
            self.assertEqual(fitted["rays"], built["rays"])
        self.assertEqual(rows[0]["nodes"], anew[0]["nodes"])
        self.assertGreater(rows[6]["nodes"], 1.05 * anew[6]["nodes"])

    def test_a_mesh_that_bends_costs_more_when_its_tree_is_kept(self):
        self.run_frames("BUNNY", "0:1", *FAST, "--fps", "4", "--structures", "refit")
        row = self.table()[1]
        self.assertEqual((row["bottom_levels_built"], row["bottom_levels_refitted"], row["top_levels_refitted"]), (0, 1, 1))
        self.assertGreater(row["expected_visits"], 1.02 * row["expected_visits_rebuilt"])
        self.assertEqual(self.statistics("out/frame-0001")["gpu.structures.expected_visits"], row["expected_visits"])

    def test_where_only_the_camera_moves_nothing_is_built_twice(self):
        self.run_frames("SPNZA", "0:1", *FAST, "--fps", "2", "--structures", "refit")
        self.assertEqual(self.statistics("out/frame-0001")["gpu.structures.top_level.kept"], 1)
        self.assertEqual(self.table()[1]["bottom_levels_built"], 0)

    def test_a_later_run_removes_the_frames_of_an_earlier_one(self):
        self.run_frames("WKND", "0:2", *FAST)
        self.run_frames("WKND", "1:1", *FAST)
        self.assertEqual(sorted(p.name for p in (self.folder / "out").iterdir() if p.is_dir()), ["frame-0001"])
        self.assertEqual(sorted(p.name for p in (self.folder / "out").glob("image*")), ["image-0001.png"])


class Timing(FramesCase):
    def test_warm_caches_show_in_later_frames_alone_and_cycles_add_up(self):
        size = ["--size", "16x16", "--spp", "1", "--shader", "sh"]
        self.run_frames("SPNZA", "0:1", *size, "--fps", "2", out="warm")
        self.run_frames("SPNZA", "0:1", *size, "--fps", "2", "--caches", "cold", out="cold")
        warm, cold = self.table("warm"), self.table("cold")
        self.assertEqual(warm[0]["cycles"], cold[0]["cycles"])
        self.assertLess(warm[1]["cycles"], cold[1]["cycles"])
        self.assertEqual(self.statistics("warm")["gpu.cycles"], warm[0]["cycles"] + warm[1]["cycles"])

    def test_with_cold_caches_a_frame_has_the_cycles_that_it_has_alone(self):
        for scene, shader in (("WKND", "pt"), ("BUNNY", "sh"), ("SPNZA", "sh")):
            size = ["--size", "16x16", "--spp", "1", "--shader", shader, "--fps", "4", "--caches", "cold"]
            self.run_frames(scene, "0:2", *size, out="all")
            self.run_frames(scene, "2", *size, out="alone")
            parts = [{path: value for path, value in self.statistics(f"{out}/frame-0002").items() if ".structures." not in path} for out in ("all", "alone")]
            self.assertEqual(*parts, scene)

    def test_a_report_has_an_axis_of_frames_and_each_frame_is_a_run_of_its_own(self):
        self.run_frames("WKND", "2:3", "--size", "16x16", "--spp", "1", "--fps", "4")
        self.expect(0, [], "report", "out")
        page = self.bytes_of("out/report.html").decode()
        figure = re.search(r'<figure data-figure="frames">.*?</figure>', page, re.DOTALL).group(0)
        for frame, row in zip(("frame-0002", "frame-0003"), self.table()):
            self.assertIn(f'<a href="{frame}/report.html"><rect', figure)
            self.assertIn(f'<title>{frame}: cycles {row["cycles"]:,.0f}'.replace(",", "\u202f"), figure)
            self.assertIn(f'<a href="{frame}/report.html">{frame}</a>', page)
        self.expect(0, [], "report", "out/frame-0002")
        self.assertIn("gpu.structures.expected_visits", self.glint("stats", "out/frame-0002").stdout)
        self.assertEqual(self.glint("compare", "out/frame-0002", "out/frame-0003").returncode, 0)
        self.expect(0, ["because its scene moves from frame to frame"], "model", "out")

    def test_both_machines_render_fitted_structures_alike_on_any_number_of_threads(self):
        size = ["--size", "16x16", "--spp", "1", "--fps", "4", "--structures", "refit"]
        self.run_frames("WKND", "0:2", *size, "--threads", "1", out="one")
        self.run_frames("WKND", "0:2", *size, "--threads", "2", out="two")
        self.run_frames("WKND", "0:2", *size, "--mode", "functional", out="functional")
        for frame in ("frame-0000", "frame-0001", "frame-0002"):
            self.assertEqual(self.bytes_of(f"one/{frame}/stats.csv"), self.bytes_of(f"two/{frame}/stats.csv"))
            self.assertEqual(self.bytes_of(f"one/{frame}/image.pfm"), self.bytes_of(f"functional/{frame}/image.pfm"))


class Animations(FramesCase):
    def boxes(self, file, frames, *more):
        """Returns where the square is in each frame, at one frame a second."""
        self.write("a.gltf", file.text())
        self.run_frames("a.gltf", frames, *FAST, "--fps", "1", *more)
        return [self.lit(f"out/image-{int(row['frame']):04}.png") for row in self.table()]

    def test_nodes_move_step_by_step_in_lines_and_in_cubic_curves(self):
        left, right = (-1, 0, 0), (1, 0, 0)
        still = self.boxes(GltfFile().move("translation", [0, 4], [(0, 0, 0), (0, 0, 0)]), "0:0")[0]
        self.assert_lit([still], [(11, 11, 20, 20)])
        step = self.boxes(GltfFile().move("translation", [0, 2, 4], [left, right, right], "STEP"), "1:2")
        self.assert_lit([box[::2] for box in step], [(0, 9), (22, 31)])
        line = self.boxes(GltfFile().move("translation", [0, 4], [left, right]), "0:4")
        self.assert_lit([box[:1] for box in line], [(0,), (5,), (11,), (16,), (22,)])
        # With tangents of 0 a quarter of the time is 5/32 of the way, and with tangents of 1 / s on the way down none is made.
        zero = (0, 0, 0)
        slow = self.boxes(GltfFile().move("translation", [0, 4], [zero, left, zero, zero, right, zero], "CUBICSPLINE"), "1:3")
        self.assert_lit([box[:1] for box in slow], [(3,), (11,), (19,)])
        fast = self.boxes(GltfFile().move("translation", [0, 4], [zero, left, (2, 0, 0), (2, 0, 0), right, zero], "CUBICSPLINE"), "1:1")
        self.assert_lit([fast[0][:1]], [(11,)])  # 5/32 of 2, and 4 * (9/64 - 3/64) * 2 of the tangents: -1 + 0.3125 + 0.75

    def test_a_rotation_goes_the_short_way_at_an_even_speed(self):
        bar = GltfFile()
        bar.nodes[0]["scale"] = [2, 0.5, 1]
        flat, turned, minus = (0, 0, 0, 1), (0, 0, TURN, TURN), (0, 0, -TURN, -TURN)
        boxes = self.boxes(bar.move("rotation", [0, 2], [flat, turned]), "0:2")
        width = [box[2] - box[0] for box in boxes]
        height = [box[3] - box[1] for box in boxes]
        self.assertEqual((width[0], height[0]), (height[2], width[2]))
        self.assertEqual(width[1], height[1])  # 45 degrees
        bar = GltfFile()
        bar.nodes[0]["scale"] = [2, 0.5, 1]
        self.assertEqual(self.boxes(bar.move("rotation", [0, 2], [flat, minus]), "0:2"), boxes)  # -q turns as q does

    def test_what_is_scaled_to_nothing_is_hidden_for_a_while(self):
        file = GltfFile().move("scale", [0, 1, 2], [(1, 1, 1), (0, 0, 0), (1, 1, 1)])
        for how in ("rebuild", "refit"):
            boxes = self.boxes(file, "0:2", "--structures", how)
            self.assert_lit(boxes, [(11, 11, 20, 20), None, (11, 11, 20, 20)])

    def test_morph_targets_are_added_with_their_weights(self):
        file = GltfFile()
        lift = file.floats([(0, 0, 0), (0, 0, 0), (0, 1, 0), (0, 1, 0)], "VEC3")
        widen = file.floats([(-0.5, 0, 0), (0.5, 0, 0), (0.5, 0, 0), (-0.5, 0, 0)], "VEC3")
        file.primitive["targets"] = [{"POSITION": lift}, {"POSITION": widen}]
        file.mesh["weights"] = [0, 0]
        file.move("weights", [0, 2], [0, 0, 1, 1])
        for how in ("rebuild", "refit"):
            boxes = self.boxes(file, "0:2", "--structures", how)
            self.assert_lit(boxes, [(11, 11, 20, 20), (8, 5, 23, 20), (5, 0, 26, 20)])
            self.assertEqual(self.table()[2]["bottom_levels_refitted"], how == "refit")

    def skinned(self):
        """The two upper corners follow a joint that turns about the middle of the lower edge; the node's own place counts for nothing."""
        file = GltfFile()
        attributes = file.primitive["attributes"]
        attributes["JOINTS_0"] = file.bytes([(0, 0, 0, 0), (0, 0, 0, 0), (1, 0, 0, 0), (1, 0, 0, 0)])
        attributes["WEIGHTS_0"] = file.floats([(1, 0, 0, 0)] * 4, "VEC4")
        file.nodes[0].update(skin=0, translation=[0.7, 0.7, 0])
        file.nodes += [{"children": [3]}, {"translation": [0, -0.5, 0]}]
        matrices = [(1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1), (1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0.5, 0, 1)]
        file.more = {"skins": [{"joints": [2, 3], "inverseBindMatrices": file.floats(matrices, "MAT4")}], "scenes": [{"nodes": [0, 1, 2]}]}
        return file

    def test_a_skin_follows_its_joints_and_not_its_node(self):
        file = self.skinned().move("translation", [0, 2], [(0, -0.5, 0), (0, 0.5, 0)], node=3)
        for how in ("rebuild", "refit"):
            self.assert_lit(self.boxes(file, "0:2", "--structures", how), [(11, 11, 20, 20), (11, 5, 20, 20), (11, 0, 20, 20)])
        root = self.skinned().move("translation", [0, 2], [(0, 0, 0), (0.5, 0, 0)], node=2)
        self.assert_lit(self.boxes(root, "0:2")[2:], [(16, 11, 25, 20)])

    def test_a_camera_and_the_animation_that_is_named_are_played(self):
        file = GltfFile().move("translation", [0, 2], [(0, 0, 4), (0.5, 0, 4)], node=1)
        self.assert_lit(self.boxes(file, "0:2", "--animation", "walk")[2:], [(5, 11, 15, 20)])
        self.write("a.gltf", file.text())
        self.expect(2, ["it has no animation 'run'", "0 ('walk')"], "run", "a.gltf", "--frames", "0:1", "--animation", "run")

    def test_wrong_animations_are_refused_with_their_place(self):
        cases = [(GltfFile().move("translation", [0, 0], [(0, 0, 0)] * 2), "the times of a sampler do not rise: key 1 is at 0 s"),
                 (GltfFile().move("translation", [0, 1], [(0, 0, 0)] * 3), "a sampler has 9 values for 2 keys"),
                 (GltfFile().move("translation", [0, 1], [(0, 0, float("inf"))] * 2), "a value of a sampler is inf"),
                 (GltfFile().move("rotation", [0, 1], [(0, 0, 0, 1)] * 2, node=7), "it names node 7")]
        matrix = GltfFile().move("translation", [0, 1], [(0, 0, 0)] * 2)
        matrix.nodes[0]["matrix"] = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
        cases.append((matrix, "it moves node 0, which has a matrix"))
        joint = self.skinned().move("translation", [0, 1], [(0, 0, 0)] * 2, node=3)
        joint.primitive["attributes"]["JOINTS_0"] = joint.bytes([(5, 0, 0, 0)] * 4)
        cases.append((joint, "a vertex names joint 5 of 2"))
        lost = self.skinned().move("translation", [0, 1], [(0, 0, 0)] * 2, node=3)
        lost.more["scenes"] = [{"nodes": [0, 1]}]
        cases.append((lost, "which is not in the scene"))
        for file, what in cases:
            self.write("a.gltf", file.text())
            self.expect(2, ["a.gltf", what], "run", "a.gltf", "--frames", "0:1", *FAST)

    def test_without_frames_a_file_is_as_it_stands(self):
        file = self.skinned().move("translation", [0, 2], [(0, -0.5, 0), (0, 0.5, 0)], node=3)
        self.write("a.gltf", file.text())
        self.assertEqual(self.glint("run", "a.gltf", *FAST, "--out", "out").returncode, 0)
        run = json.loads(self.bytes_of("out/run.json"))
        self.assertIn("Skins and animations are not read.", run["scene"]["note"])
        self.assert_lit([self.lit("out/image.png")], [(19, 3, 28, 12)])  # at its node's place
        self.assertNotIn("sequence", run)


class CameraPaths(FramesCase):
    KEYS = '[[key]]\ntime = 0\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n[[key]]\ntime = 2\neye = [0.5, 0, 4]\ntarget = [0.5, 0, 0]\n'

    def test_a_path_moves_the_camera_of_a_scene_in_which_nothing_moves(self):
        self.write("a.gltf", GltfFile().text())
        self.write("path.toml", self.KEYS)
        self.run_frames("a.gltf", "0:2", *FAST, "--fps", "1", "--camera-path", "path.toml")
        self.assert_lit([self.lit(f"out/image-000{i}.png")[:1] for i in range(3)], [(11,), (8,), (5,)])
        self.assertEqual(json.loads(self.bytes_of("out/run.json"))["sequence"]["camera_path"], "path.toml")

    def test_a_path_that_cannot_be_followed_is_refused_at_its_line(self):
        cases = [('[[key]]\ntime = 0\neye = [0, 0, 4]\ntarget = [0, 0, 0]\n', "path.toml", "needs two keys or more, and this one has 1"),
                 (self.KEYS.replace("time = 2", "time = 0"), "path.toml:5", "the key is at 0 s, and the one before it at 0 s"),
                 (self.KEYS.replace("eye = [0.5, 0, 4]", "eye = [0.5, 0, 0]"), "path.toml:5", "looks at its own place"),
                 (self.KEYS.replace("eye = [0, 0, 4]", "eye = [0, 4]"), "path.toml:3", "'eye' is a list of three numbers"),
                 (self.KEYS.replace("eye = [0, 0, 4]\n", ""), "path.toml:1", "'eye' is a list of three numbers"),
                 (self.KEYS + "fov = 180\n", "path.toml:5", "above 0 and below 180"),
                 (self.KEYS + "zoom = 2\n", "path.toml:9", "zoom"),
                 ('interpolation = "curved"\n' + self.KEYS, "path.toml:1", "smooth")]
        for text, place, what in cases:
            self.write("path.toml", text)
            self.expect(2, [place, what], "run", "WKND", "--frames", "0:1", "--camera-path", "path.toml")

    def test_what_makes_no_sequence_is_refused(self):
        self.write("path.toml", self.KEYS)
        for arguments, what in [
                (["WKND", "--frames", "0:49"], "frame 49 is at 2.04167 s, and the motion of WKND ends at 2 s"),
                (["WKND", "--frames", "0:49"], "it has the frames 0:48"),
                (["WKND", "--frames", "4:2"], "--frames is '4:2', expected the first and the last frame"),
                (["WKND", "--frames", "one"], "--frames is 'one'"),
                (["SHIP", "--frames", "0:1"], "nothing moves in SHIP, so it has no frames"),
                (["WKND", "--fps", "12"], "--fps belongs to a sequence of frames"),
                (["WKND", "--caches", "cold"], "--caches belongs to Amber scripts and to --frames"),
                (["WKND", "--frames", "0:1", "--camera-path", "path.toml", "--eye", "1,2,3"], "both place the camera"),
                (["WKND", "--frames", "0:1", "--camera-path", "none.toml"], "none.toml")]:
            self.expect(2, [what], "run", *arguments)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
