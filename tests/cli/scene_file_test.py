# Tests scenes of the user's own files: glTF with its nodes, materials, camera and lamp; OBJ; instances of copies.
# SPDX-License-Identifier: Apache-2.0
"""usage: scene_file_test.py GLINT SOURCE_DIR"""
import base64
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import unittest
import zlib

GLINT, SOURCE = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve()
RED, GREEN = 0, 1  # materials of the glTF files here, which glow


def png(rows):
    """Returns a picture of rows of (r, g, b, a)."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    texels = b"".join(b"\0" + bytes(sum(row, ())) for row in rows)
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 6, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(texels)) + chunk(b"IEND", b"")


def uri(data, kind="application/octet-stream"):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def gltf(nodes, **more):
    """Returns unit squares in x and y around the origin that face +z. Mesh i has material i. A camera at z = 4 sees them unless `nodes` have one."""
    corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)]
    positions = b"".join(struct.pack("<3f", x, y, 0) for x, y in corners)
    coordinates = b"".join(struct.pack("<2f", 2 * (x + 0.5), y + 0.5) for x, y in corners)  # u to 2: the texture twice
    data = positions + coordinates + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    materials = more.pop("materials", [{"emissiveFactor": [0.25, 0, 0]}, {"emissiveFactor": [0, 1, 0]}])
    file = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes, "materials": materials,
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 2, "material": i}]} for i in range(len(materials))],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "buffers": [{"byteLength": len(data), "uri": uri(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 32},
                        {"buffer": 0, "byteOffset": 80, "byteLength": 12}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4, "type": "VEC3", "min": [-0.5, -0.5, 0], "max": [0.5, 0.5, 0]},
                      {"bufferView": 1, "componentType": 5126, "count": 4, "type": "VEC2"},
                      {"bufferView": 2, "componentType": 5123, "count": 6, "type": "SCALAR"}]}
    file.update(more)
    return json.dumps(file)


CAMERA = {"camera": 0, "translation": [0, 0, 4]}


class SceneFiles(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = pathlib.Path(temporary.name)

    def glint(self, *arguments):
        return subprocess.run([GLINT, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True, timeout=120)

    def render(self, name, text=None, *more):
        """Returns the picture as rows of (r, g, b) in 0 to 255, 32 x 32, and run.json."""
        if text:
            (self.folder / name).write_text(text)
        done = self.glint("run", name, "--mode", "functional", "--size", "32x32", "--spp", "1", "--out", "out", *more)
        if "libtinygltf-dev" in done.stderr:
            self.skipTest("SKIPPED: this Glint was built without libtinygltf-dev")
        self.assertEqual(done.returncode, 0, done.stderr)
        return self.read_picture(), json.loads((self.folder / "out/run.json").read_text())

    def read_picture(self):
        data = (self.folder / "out/image.png").read_bytes()
        width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
        self.assertEqual((width, height, depth), (32, 32, 8))
        channels = {2: 3, 6: 4}[kind]
        packed, at = b"", 8
        while at < len(data):
            size, name = struct.unpack(">I4s", data[at:at + 8])
            packed += data[at + 8:at + 8 + size] if name == b"IDAT" else b""
            at += 12 + size
        raw, rows, above = zlib.decompress(packed), [], bytes(width * channels)
        for y in range(height):
            line = bytearray(raw[y * (width * channels + 1) + 1:(y + 1) * (width * channels + 1)])
            self.unfilter(raw[y * (width * channels + 1)], line, above, channels)
            rows.append([tuple(line[x * channels:x * channels + 3]) for x in range(width)])
            above = bytes(line)
        return rows

    def unfilter(self, kind, line, above, step):
        for i in range(len(line)):
            left, up, corner = line[i - step] if i >= step else 0, above[i], above[i - step] if i >= step else 0
            paeth = min((left, up, corner), key=lambda v: (abs(left + up - corner - v), (left, up, corner).index(v)))
            line[i] = (line[i] + (0, left, up, (left + up) // 2, paeth)[kind]) & 255

    def refused(self, text, *parts):
        (self.folder / "bad.gltf").write_text(text)
        done = self.glint("run", "bad.gltf")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertEqual(done.stderr.count("error:"), 1, done.stderr)
        for part in ("bad.gltf", *parts):
            self.assertIn(part, done.stderr)

    def test_nodes_place_meshes_and_one_mesh_may_stand_twice(self):
        nodes = [{"mesh": RED, "translation": [-0.7, 0, 0]}, {"mesh": GREEN, "translation": [0, 0.7, 0], "children": [3]}, CAMERA,
                 {"mesh": RED, "translation": [0.7, -0.7, 0], "scale": [0.5, 0.5, 0.5]}]
        picture, run = self.render("three.gltf", gltf(nodes).replace('"scenes": [{"nodes": [0, 1, 2, 3]}]', '"scenes": [{"nodes": [0, 1, 2]}]'))
        self.assertEqual(picture[16][8], (128, 0, 0))    # sqrt(0.25)
        self.assertEqual(picture[8][16], (0, 255, 0))
        self.assertEqual(picture[16][23], (128, 0, 0))   # the child, from its parent's place
        self.assertEqual(picture[16][29], (0, 0, 0))     # half as large; no sky where something glows
        self.assertEqual((run["scene"]["form"], run["scene"]["triangles"]), ("file", 6))

    def test_a_turned_and_unevenly_scaled_square_is_lit_as_its_normal_says(self):
        # A surface whose normal points up sees the sky's light above it, and one that points down does not.
        grey = {"pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.5, 0.5, 1], "metallicFactor": 0}}
        tilt = {"mesh": 0, "rotation": [-0.5, 0, 0, 0.8660254], "scale": [1, 3, 1]}  # 60 degrees: the normal is up and towards the camera
        up, _ = self.render("up.gltf", gltf([tilt, CAMERA], materials=[grey]), "--shader", "sh")
        down, _ = self.render("down.gltf", gltf([dict(tilt, rotation=[0.5, 0, 0, 0.8660254]), CAMERA], materials=[grey]), "--shader", "sh")
        self.assertAlmostEqual(sum(up[16][16]) / 3, 255 * 0.5 ** 0.5, delta=1)
        self.assertAlmostEqual(sum(down[16][16]) / 3, 255 * (0.5 * 0.09) ** 0.5, delta=1)  # two shadow rays, each 0.3

    def test_a_masked_texture_repeats_and_lets_through_what_is_behind(self):
        texture = png([[(255, 255, 255, 255)] * 4 + [(255, 255, 255, 10)] * 4] * 4)
        mask = {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}, "alphaMode": "MASK"}
        text = gltf([{"mesh": 0, "scale": [2, 2, 2]}, {"mesh": 1, "translation": [0, 0, -0.5], "scale": [3, 3, 3]}, CAMERA],
                    materials=[mask, {"emissiveFactor": [0, 1, 0]}], textures=[{"source": 0}], images=[{"uri": uri(texture, "image/png")}])
        picture, _ = self.render("mask.gltf", text)
        row = [green for _, green, _ in picture[16]]
        inside = row[5:27]  # what the square covers
        edges = [x for x in range(1, len(inside)) if (inside[x] == 255) != (inside[x - 1] == 255)]
        # The texture lies there two times, so the row is twice not masked and twice masked. The filter adds half of the first column at the right edge.
        self.assertEqual(len(edges), 4, row)

    def test_a_point_light_is_a_lamp_and_takes_the_skys_place(self):
        light = {"extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}, "extensionsUsed": ["KHR_lights_punctual"]}
        grey = {"pbrMetallicRoughness": {"metallicFactor": 0}}
        nodes = [{"mesh": 0}, CAMERA, {"translation": [0, 0.8, 0], "extensions": {"KHR_lights_punctual": {"light": 0}}}]
        picture, run = self.render("lamp.gltf", gltf(nodes, materials=[grey], **light))
        self.assertEqual(max(max(row) for row in picture), (255, 255, 255))  # the ball of light itself
        self.assertEqual(picture[0][0], (0, 0, 0))
        self.assertEqual(run["scene"]["triangles"], 2)

    def test_without_a_camera_all_of_it_is_seen(self):
        picture, run = self.render("square.gltf", gltf([{"mesh": GREEN, "translation": [1000, 0, 0], "scale": [40, 40, 40]}]))
        self.assertIn("no camera", run["scene"]["note"])
        green = [(x, y) for y in range(32) for x in range(32) if picture[y][x] == (0, 255, 0)]
        self.assertGreater(len(green), 60)
        self.assertTrue(all(0 < x < 31 and 0 < y < 31 for x, y in green))

    def test_mistakes_are_named_with_their_file(self):
        self.refused(gltf([{"mesh": 7}]), "it names mesh 7, and it has 2")
        self.refused(gltf([{"mesh": 0}, {"camera": 3}]), "it names camera 3, and it has 1")
        self.refused(gltf([CAMERA]), "no triangles")
        self.refused(gltf([{"mesh": 0}], extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression")
        self.refused(gltf([{"mesh": 0, "name": "leaf", "children": [0]}]), "node 0 ('leaf')", "stands below itself")
        # Without the check, twenty such levels are a million instances.
        doubled = [{"children": [i + 1, i + 1]} for i in range(40)] + [{"mesh": 0}]
        self.refused(gltf(doubled), "node 40", "two parents")
        self.refused(gltf([CAMERA, {"mesh": 0}, {"mesh": 0, "name": "flat", "scale": [1, 0, 1]}]), "node 2 ('flat')", "flattens its mesh")
        self.refused(gltf([CAMERA, {"mesh": 0}, {"mesh": 0, "name": "far", "translation": [3.4e38, 0, 0], "scale": [1e38, 1, 1]}]),
                     "node 2 ('far')", "moves its mesh to infinity")
        self.refused(gltf([{"mesh": 0}]).replace(uri(b"")[:37] + uri(struct.pack("<f", -0.5))[37:42], uri(b"")[:37] + uri(b"\0\0\xc0\x7f")[37:42]),
                     "in mesh 0", "a position is (nan, -0.5, 0)")
        textured = [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]
        self.refused(gltf([{"mesh": 0}], materials=textured, textures=[{"source": 0}], images=[{"uri": "wood.png"}]),
                     "the picture of image 0 ('wood.png') cannot be read")
        self.refused(gltf([{"mesh": 0}], materials=textured, textures=[{"source": 0}], images=[{"uri": uri(b"no picture", "image/png"), "name": "bark"}]),
                     "image 0 ('bark') is no PNG or JPEG picture: unknown image type")
        self.refused(gltf([{"mesh": 0}], materials=textured, textures=[{}], images=[]), "it names image -1, and it has 0")
        self.refused(gltf([{"mesh": 0}]).replace('"count": 4', '"count": 400'), "leaves its buffer")
        self.refused("{}", "cannot be read")
        done = self.glint("run", "missing.gltf")
        self.assertEqual(done.returncode, 2)
        self.assertIn("there is no such file", done.stderr)

    def test_threads_that_read_a_large_mesh_do_not_show(self):
        subprocess.run([sys.executable, SOURCE / "bench/make_hills.py", "200000", self.folder / "hills.glb"], check=True)
        one, run = self.render("hills.glb", None, "--threads", "1", "--no-cache")
        several, same = self.render("hills.glb", None, "--threads", "3", "--no-cache")
        self.assertEqual(one, several)
        self.assertEqual(run["scene"]["hash"], same["scene"]["hash"])
        self.assertEqual(run["structures"], same["structures"])
        # Of two wrong positions, which different threads read, the first is named.
        data = bytearray((self.folder / "hills.glb").read_bytes())
        first = 28 + struct.unpack_from("<I", data, 12)[0]
        for vertex, wrong in ((60_000, math.inf), (90_000, -math.inf)):
            struct.pack_into("<f", data, first + 12 * vertex, wrong)
        (self.folder / "bad.glb").write_bytes(data)
        for threads in "123":
            done = self.glint("run", "bad.glb", "--threads", threads)
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn("in mesh 0 ('hills'): a position is (inf,", done.stderr)

    def test_mistakes_in_an_obj_file_are_named_with_their_line(self):
        corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvn 0 0 1\n"
        for text, *parts in [
                (corners + "f 1 2 900000000\n", "bad.obj:6", "names vertex 900000000, and the file has 3"),
                (corners + "f 1 2 9\n", "bad.obj:6", "names vertex 9"),
                (corners + "f 1 2 -4\n", "bad.obj:6", "names vertex -4, and 3 stand above it"),
                ("v 0 0 0\nf 1 -2 1\nv 1 1 1\n", "bad.obj:2", "names vertex -2, and 1 stand above it"),
                (corners + "f 1/1 2/2 3/1\n", "bad.obj:6", "names texture coordinate 2, and the file has 1"),
                (corners + "f 1//1 2//1 3//7\n", "bad.obj:6", "names normal 7"),
                (corners + "f 1 0 2\n", "bad.obj:6", "names vertex 0"),
                (corners + "f 1 2 99999999999999999999\n", "bad.obj:6", "names vertex 99999999999999999999"),
                (corners + "f 1 2 three\n", "bad.obj:6", "'three' is not the number of a vertex"),
                (corners + "f" + " 1 2 3" * 86 + "\n", "bad.obj:6", "has 258 corners"),
                ("v 0 nan 0\n" + corners + "f 1 2 3\n", "bad.obj:1", "'nan' is not a finite number"),
                ("v 0 0 1e39\n" + corners + "f 1 2 3\n", "bad.obj:1", "'1e39' is not a finite number"),
                ("v 0 0\n" + corners + "f 1 2 3\n", "bad.obj:1", "has 2 of 3 numbers")]:
            with self.subTest(text=text[-40:]):
                (self.folder / "bad.obj").write_text(text)
                done = self.glint("run", "bad.obj", "--size", "4x4", "--spp", "1", "--out", "out")
                self.assertEqual(done.returncode, 2, done.stderr)
                for part in parts:
                    self.assertIn(part, done.stderr)

    def test_numbers_of_every_spelling_are_read(self):
        spellings = "v +0 0.0e0 -0\r\nv 1e0 1e-400 0\r\n\tv\t0 1. .0\r\nvt .5\r\nf 1/1 2/1/ -1/-1\r\nf 1 2\r\n"
        _, run = self.render("spellings.obj", spellings)
        self.assertEqual(run["scene"]["triangles"], 1)

    def test_copies_of_an_obj_scene_share_what_they_have_and_look_the_same(self):
        (self.folder / "body.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        alone, run = self.render("body.obj", None, "--shader", "ao")
        again, same = self.render("body.obj", None, "--shader", "ao", "--instancing")
        self.assertEqual(alone, again)  # one model has nothing to share
        self.assertEqual(run["scene"]["hash"], same["scene"]["hash"])
        self.assertEqual(run["scene"]["triangles"], 4)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[3:]])
