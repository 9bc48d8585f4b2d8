# Tests that damaged input of every kind ends with an exit code of docs/errors.md and a message, and never with a crash or a hang.
# SPDX-License-Identifier: Apache-2.0
"""usage: mutation_test.py GLINT SOURCE_DIR [SUITE...]

GLINT_MUTATIONS=N damages N inputs of each kind instead of a few, and GLINT_MUTATION_SEED=N begins with another seed. A failure names the seed of
its input, which GLINT_MUTATIONS=1 GLINT_MUTATION_SEED=N repeats."""
import json
import os
import pathlib
import random
import re
import shutil
import struct
import subprocess
import zlib

from glint_case import GLINT, ROOT, GlintTest, main, png_bytes

COUNT, FIRST = int(os.environ.get("GLINT_MUTATIONS", "25")), int(os.environ.get("GLINT_MUTATION_SEED", "1"))
SECONDS = 60  # for an input; a sanitizer slows all of them down
EXITS = (0, 1, 2, 3, 4, 5)
TOKENS = [b"0", b"-1", b"1", b"99999999999999999999", b"4294967295", b"2147483648", b"1e308", b"nan", b"-inf", b'""', b"{}", b"[]", b"null", b"true", b'"',
          b"[", b"{", b"\0", b"\xff", b"/", b"..", b"\n", b"#", b"=", b",", b"1e-400", b"65536", b"16777216"]
PNG = png_bytes(2, 2, bytes(16))
WORD = re.compile(rb'-?[0-9]+(?:\.[0-9]+)?|"[^"\n]*"|\b[a-z_]+\b')
FRAME = ["--size", "4x4", "--spp", "1", "--mode", "functional", "--out", "out", "--max-instructions", "20000"]


def damaged(data, dice):
    """Returns the bytes with one to five changes: bits, cuts, copies, lines, or words replaced by extreme ones."""
    data = bytearray(data)
    for _ in range(dice.choice([1, 1, 1, 2, 3, 5])):
        at, kind = dice.randrange(len(data) or 1), dice.randrange(8)
        words = list(WORD.finditer(bytes(data))) if kind > 4 else []
        if kind == 0 and data:
            data[at] ^= 1 << dice.randrange(8)
        elif kind == 1:
            del data[at:at + dice.choice([1, 4, 16, 64])]
        elif kind == 2:
            data[at:at] = dice.choice(TOKENS)
        elif kind == 3:
            start = dice.randrange(len(data) or 1)
            data[at:at] = data[start:start + dice.choice([4, 16, 64])]
        elif kind == 4:
            data = data[:at] if dice.random() < 0.3 else data
        elif words:
            word = dice.choice(words)
            data[word.start():word.end()] = dice.choice(TOKENS) if kind < 7 else dice.choice(words)[0]
    return bytes(data)


def exr():
    """Returns an EXR file of 2 by 2 pixels with one channel, without compression."""
    def attribute(name, kind, value):
        return name + b"\0" + kind + b"\0" + struct.pack("<I", len(value)) + value
    head = b"\x76\x2f\x31\x01" + struct.pack("<I", 2) + b"".join((
        attribute(b"channels", b"chlist", b"Y\0" + struct.pack("<IIII", 2, 0, 1, 1) + b"\0"), attribute(b"compression", b"compression", b"\0"),
        attribute(b"dataWindow", b"box2i", struct.pack("<4i", 0, 0, 1, 1)), attribute(b"displayWindow", b"box2i", struct.pack("<4i", 0, 0, 1, 1)),
        attribute(b"lineOrder", b"lineOrder", b"\0"), attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", bytes(8)), attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)))) + b"\0"
    first = len(head) + 16
    return head + struct.pack("<QQ", first, first + 16) + b"".join(struct.pack("<ii2f", y, 8, 0.25, 0.5 + y) for y in range(2))


def pfm():
    return b"PF\n2 2\n-1.0\n" + struct.pack("<12f", *(0.25 * i for i in range(12)))


def glb():
    """Returns one triangle with a camera and a picture that lies in the file."""
    data = struct.pack("<9f", -1, -1, 0, 1, -1, 0, 0, 1, 0) + PNG
    data += bytes(-len(data) % 4)
    text = json.dumps({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "children": [2]}, {"camera": 0, "translation": [0, 0, 4]}, {"mesh": 0, "scale": [1, 2, 1]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}], "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}, "alphaMode": "MASK"}], "textures": [{"source": 0}],
        "images": [{"bufferView": 1, "mimeType": "image/png"}], "buffers": [{"byteLength": len(data)}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": len(PNG)}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1, -1, 0], "max": [1, 1, 0]}]}).encode()
    text += b" " * (-len(text) % 4)
    parts = struct.pack("<II", len(text), 0x4e4f534a) + text + struct.pack("<II", len(data), 0x4e4942) + data
    return struct.pack("<III", 0x46546c67, 2, 12 + len(parts)) + parts


class Damage(GlintTest):
    def check(self, seed, name, *arguments):
        """Runs glint, which must end in time, with a known exit code, and with a message unless the code is 0."""
        with self.subTest(seed=seed, file=name, arguments=arguments):
            done = subprocess.run([GLINT, *arguments], cwd=self.folder, capture_output=True, timeout=SECONDS, stdin=subprocess.DEVNULL,
                                  env={**os.environ, "GLINT_CACHE": str(self.folder / "cache")})
            said = done.stderr.decode(errors="replace")
            self.assertIn(done.returncode, EXITS, said)
            self.assertTrue(done.returncode == 0 or said.strip())
            self.assertNotIn("out of memory", said)

    def damage(self, name, data, *arguments):
        """Runs glint with each of the damaged forms of one file."""
        path = self.folder / name
        for seed in range(FIRST, FIRST + COUNT):
            path.write_bytes(damaged(data, random.Random(f"{name} {seed}")))
            self.check(seed, name, *arguments)
        path.write_bytes(data)


class Scenes(Damage):
    def test_obj_and_its_materials(self):
        (self.folder / "a.png").write_bytes(PNG)
        materials = b"newmtl m\nKd 0.5 0.5 0.5\nmap_Kd a.png\n"
        (self.folder / "a.mtl").write_bytes(materials)
        mesh = b"mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvn 0 0 1\nusemtl m\nf 1 3 2\nf 1/1/1 2/1/1 -1/1/1\ng a\nf 1//1 2//1 3//1 4//1\n"
        self.damage("a.obj", mesh, "run", "a.obj", *FRAME)
        self.damage("a.mtl", materials, "run", "a.obj", *FRAME)
        self.damage("a.png", PNG, "run", "a.obj", *FRAME)
        for name, data in (("a.exr", exr()), ("a.pfm", pfm())):
            (self.folder / "a.mtl").write_bytes(materials.replace(b"a.png", name.encode()))
            self.damage(name, data, "run", "a.obj", *FRAME)

    def test_gltf_in_both_forms(self):
        data = glb()
        self.damage("a.glb", data, "run", "a.glb", *FRAME)
        length = struct.unpack("<I", data[12:16])[0]
        file = json.loads(data[20:20 + length])
        (self.folder / "a.bin").write_bytes(data[28 + length:])
        file["buffers"][0]["uri"] = "a.bin"
        self.damage("a.gltf", json.dumps(file).encode(), "run", "a.gltf", *FRAME)


class Texts(Damage):
    def test_configurations(self):
        self.damage("c.toml", (ROOT / "configs/mobile.toml").read_bytes(), "run", "WKND", "--size", "2x2", "--spp", "1", "--config", "c.toml", "--out", "out",
                    "--max-instructions", "20000")

    def test_pipelines_and_kernels(self):
        for source, name in ((ROOT / "examples/spheres", "pipeline.toml"), (ROOT / "examples/mandelbrot", "pipeline.toml"), (ROOT / "shaders/kernels", "saxpy.toml")):
            shutil.copytree(source, self.folder / source.name)
            self.damage(f"{source.name}/{name}", (source / name).read_bytes(), "run", f"{source.name}/{name}", *FRAME[5:])

    def test_pictures_of_pipelines(self):
        (self.folder / "p.comp").write_text("#version 460\nlayout(local_size_x = 2, local_size_y = 2) in;\nlayout(binding = 0) uniform sampler2D t;\n"
                                            "layout(binding = 1, rgba32f) uniform image2D o;\n"
                                            "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(o, p, texelFetch(t, p, 0)); }\n")
        for name, data in (("a.exr", exr()), ("a.pfm", pfm())):
            (self.folder / "p.toml").write_text(f"[compute]\nshader = 'p.comp'\n[launch]\ngroups = 1\n[[image]]\nbinding = 0\nfile = '{name}'\n"
                                                "[[image]]\nbinding = 1\nsave = 'o.exr'\n")
            self.damage(name, data, "run", "p.toml", *FRAME[5:])

    def test_shaders_kernels_and_scripts(self):
        self.damage("a.comp", (ROOT / "examples/mandelbrot/mandelbrot.comp").read_bytes(), "compile", "a.comp")
        self.damage("a.ptx", (ROOT / "shaders/kernels/saxpy.ptx").read_bytes(), "compile", "a.ptx")
        script = min((ROOT / "tests/amber/scripts").glob("*.amber"), key=lambda path: (path.stat().st_size, path.name))
        self.damage("a.amber", script.read_bytes(), "run", "a.amber", "--max-instructions", "20000")


class RunFiles(Damage):
    READERS = (["report", "run", "-o", "page.html"], ["stats", "run", "--format", "metrics"], ["compare", "run", "whole"], ["annotate", "run"], ["imgdiff", "run", "whole"],
               ["model", "run", "--statistics-only"])

    def test_every_file_of_a_run(self):
        done = self.glint("run", "WKND", "--size", "8x8", "--spp", "1", "--profile", "--sample", "500", "--out", "whole")
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("run.json", "stats.csv", "stats.json", "config.toml", "series.csv", "profile.csv", "source.json", "image.pfm", "image.png"):
            self.damage_file_of_run(name, (self.folder / "whole" / name).read_bytes())

    def damage_file_of_run(self, name, data):
        for seed in range(FIRST, FIRST + max(1, COUNT // 3)):
            dice = random.Random(f"{name} {seed}")
            shutil.rmtree(self.folder / "run", ignore_errors=True)
            shutil.copytree(self.folder / "whole", self.folder / "run")
            changed = damaged(data, dice)
            (self.folder / "run" / name).write_bytes(changed)
            self.accept(pathlib.Path(self.folder / "run"), name, changed)
            self.check(seed, name, *dice.choice(self.READERS))

    def accept(self, run, name, data):
        """Puts the new sum of a file into run.json, so that readers go on to what the file holds."""
        if name == "run.json":
            return
        facts = json.loads((run / "run.json").read_text())
        facts["files"][name] = {"bytes": len(data), "crc32": f"{zlib.crc32(data):08x}"}
        (run / "run.json").write_text(json.dumps(facts))


if __name__ == "__main__":
    main()
