# Tests `glint run FILE.toml`: examples, inputs, outputs, and all kinds of mistakes.
# SPDX-License-Identifier: Apache-2.0
"""usage: pipeline_test.py GLINT SOURCE_DIR [SUITE...]"""
import base64
import json
import shutil
import struct
import subprocess

import glint_case
from glint_case import ROOT
from pipeline_case import ADD, PICTURES, PipelineTest

def npy(path):
    """Returns header text and bytes of a NumPy file."""
    data = path.read_bytes()
    assert data[:8] == b"\x93NUMPY\x01\x00", data[:8]
    length = struct.unpack("<H", data[8:10])[0]
    assert (10 + length) % 64 == 0
    return data[10:10 + length].decode(), data[10 + length:]


# tests/python runs the notebooks, policy_test.py the policies, tests/vulkan the programs for graphics cards.
TESTED_ELSEWHERE = ("notebooks", "policies", "rt_frames", "rt_microbench")


class Examples(PipelineTest):
    def test_every_example_gives_the_picture_of_the_docs_on_both_machines(self):
        for name in PICTURES:
            for mode in ("functional", "timing"):
                with self.subTest(example=name, mode=mode):
                    done = self.glint("run", ROOT / "examples" / name / "pipeline.toml", "--mode", mode, "--out", name)
                    self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
                    self.assertEqual(glint_case.read_png(self.folder / name / "picture.png"), glint_case.read_png(ROOT / f"docs/images/example_{name}.png"))

    def test_the_reduction_sums_blocks_of_256(self):
        sums = [sum(range(256 * i, 256 * i + 256)) for i in range(16)]
        for mode in ("functional", "timing"):
            done = self.glint("run", ROOT / "examples/reduction/pipeline.toml", "--mode", mode, "--out", "out")
            self.assertEqual(done.returncode, 0, done.stderr)
            self.assertEqual((self.folder / "out/sums.csv").read_text().split(), ["value", *map(str, sums)])
        header, data = npy(self.folder / "out/sums.npy")
        self.assertIn("'descr': '<u4'", header)
        self.assertIn("'shape': (16,)", header)
        self.assertEqual(list(struct.unpack("<16I", data)), sums)

    def test_every_example_has_its_page_and_its_test(self):
        names = {p.name for p in (ROOT / "examples").iterdir() if p.is_dir()}
        self.assertEqual(names, {*PICTURES, "reduction", *TESTED_ELSEWHERE})
        page = (ROOT / "docs/pipelines.md").read_text()
        for name in names - set(TESTED_ELSEWHERE):
            self.assertIn(f"examples/{name}", page)

    def test_a_run_leaves_a_complete_directory(self):
        self.run_file(ROOT / "examples/mandelbrot/pipeline.toml")
        for name in ("config.toml", "run.json", "stats.txt", "stats.json", "stats.csv", "picture.png", "picture.npy"):
            self.assertTrue((self.folder / "out" / name).is_file(), name)
        run = json.loads((self.folder / "out/run.json").read_text())
        self.assertEqual(run["exit"], 0)
        self.assertIn("(128, 128, 4)", npy(self.folder / "out/picture.npy")[0])


class Lists(PipelineTest):
    LIST = (ROOT / "examples/denoise/pipeline.toml")

    def cycles(self, folder):
        row = next(r for r in (self.folder / folder / "stats.csv").read_text().splitlines() if r.startswith("gpu.cycles,"))
        return int(row.split(",")[1])

    def test_launches_have_run_directories_and_the_run_has_their_sum(self):
        done = self.glint("run", self.LIST, "--out", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        launches = json.loads((self.folder / "out/run.json").read_text())["launches"]
        self.assertEqual(launches, ["launch-0-trace", "launch-1-denoise"])
        parts = [self.cycles(f"out/{name}") for name in launches]
        self.assertEqual(self.cycles("out"), sum(parts))
        shaders = [json.loads((self.folder / "out" / name / "run.json").read_text())["shader"] for name in launches]
        self.assertEqual(shaders, ["trace.rgen", "denoise.comp"])
        done = self.glint("report", "out")
        self.assertEqual(done.returncode, 0, done.stderr)
        page = (self.folder / "out/report.html").read_text()
        for name in launches:
            self.assertIn(f'<a href="{name}/report.html">{name}</a>', page)

    def test_warm_caches_save_cycles_of_the_second_launch_and_change_nothing_else(self):
        self.copy("denoise")
        cold = self.edit(('caches = "warm"\n', ""))
        for file, out in ((self.folder / "pipeline.toml", "warm"), (cold, "cold")):
            done = self.glint("run", file, "--out", out)
            self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.cycles("warm/launch-0-trace"), self.cycles("cold/launch-0-trace"))
        self.assertLess(self.cycles("warm/launch-1-denoise"), self.cycles("cold/launch-1-denoise"))
        self.assertEqual((self.folder / "warm/picture.png").read_bytes(), (self.folder / "cold/picture.png").read_bytes())

    def test_launches_of_an_earlier_run_are_removed(self):
        self.copy("denoise")
        self.run_file(self.folder / "pipeline.toml")
        self.run_file(self.edit(('name = "trace"', 'name = "rays"')))
        self.assertFalse((self.folder / "out/launch-0-trace").exists())
        self.assertTrue((self.folder / "out/launch-0-rays/run.json").is_file())

    def test_a_launch_that_is_cut_ends_the_list(self):
        done = self.glint("run", self.LIST, "--out", "out", "--max-cycles", "6000")
        self.assertEqual(done.returncode, 6, done.stderr)
        for name in ("out", "out/launch-0-trace"):
            self.assertEqual(json.loads((self.folder / name / "run.json").read_text())["partial"]["cycles"], 6027)
        self.assertFalse((self.folder / "out/launch-1-denoise").exists())

    def test_frames_repeat_the_list_with_their_number(self):
        self.copy("temporal")
        self.run_file(self.edit(("count = 8", "count = 2")))
        launches = json.loads((self.folder / "out/run.json").read_text())["launches"]
        self.assertEqual(launches, [f"launch-{3 * frame + i}-frame{frame}-{name}"
                                    for frame in (0, 1) for i, name in enumerate(("trace", "accumulate", "denoise"))])

    def test_accumulation_over_frames_brings_noise_down(self):
        self.copy("temporal")
        errors = []
        for count in (1, 16):
            self.run_file(self.edit(("count = 8", f"count = {count}"), ("reach = 2", "reach = 0")))
            _, _, picture = glint_case.read_png(self.folder / "out/picture.png")
            floor = [picture[3 * (y * 96 + x)] for y in range(80, 96) for x in range(96)]  # the open floor sees most of the sky
            mean = sum(floor) / len(floor)
            errors.append((sum((light - mean) ** 2 for light in floor) / len(floor)) ** 0.5)
        self.assertLess(errors[1], 0.5 * errors[0])

    def test_frames_without_a_list_or_without_a_number_are_refused(self):
        self.copy("temporal")
        for old, new, message in (("count = 8", "count = 0", "expected 1 to 10000"), ("count = 8", "counts = 8", "[frames] needs 'count'"),
                                  ("count = 8", 'count = 8\nfirst = 2', "first")):
            done = self.glint("run", self.edit((old, new)), "--mode", "functional", "--out", "out")
            self.assertEqual(done.returncode, 2, done.stderr)
            self.assertIn(message, done.stderr)
        spheres = (ROOT / "examples/spheres/pipeline.toml").read_text()
        self.copy("spheres")
        (self.folder / "framed.toml").write_text(spheres + "\n[frames]\ncount = 2\n")
        done = self.glint("run", "framed.toml", "--mode", "functional", "--out", "out")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("[frames] repeats a list of launches, and there is none", done.stderr)

    def test_mistakes_of_lists_name_their_lines(self):
        self.copy("denoise")
        for old, new, message in (('name = "denoise"', 'name = "trace"', "there are two launches 'trace'"),
                                  ('raygen = "trace.rgen"\n', "", "a launch needs 'raygen' or 'compute', a shader"),
                                  ('compute = "denoise.comp"', 'compute = "denoise.comp"\nraygen = "trace.rgen"', "a launch has 'raygen' or 'compute', not both"),
                                  ('name = "trace"', 'name = "../trace"', "so it has no slash"),
                                  ("groups = [16, 32]", "size = [16, 32]", "a compute shader is launched in 'groups'")):
            with self.subTest(message=message):
                done = self.glint("run", self.edit((old, new)), "--mode", "functional", "--out", "out")
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertRegex(done.stderr, r"edited\.toml:\d+:\d+: error: ")
                self.assertIn(message, done.stderr)


ADD_FILE = """[compute]
shader = "SHADER"
[launch]
groups = 1
[[buffer]]
set = 1
binding = 2
data = { a = [10, 0, 0, 0], b = [1, 2, 3] }
[[buffer]]
binding = 0
type = "f32"
count = 4
save = "out.csv"
"""


class Inputs(PipelineTest):
    def test_members_go_where_the_shaders_layout_wants_them(self):
        self.write("add.comp", ADD)
        self.run_file(self.write("p.toml", ADD_FILE.replace("SHADER", "add.comp")))
        self.assertEqual(self.saved_numbers(), [11, 12, 13, 11])

    def test_a_specialisation_constant_is_set_by_name_and_by_number(self):
        self.write("add.comp", ADD)
        for key in ("FACTOR", "3"):
            self.run_file(self.write("p.toml", ADD_FILE.replace("SHADER", "add.comp") + f"[specialization]\n{key} = -2\n"))
            self.assertEqual(self.saved_numbers(), [-22, -24, -26, -22])

    def test_text_and_binary_spirv_run_like_their_source(self):
        self.write("add.comp", ADD)
        done = self.glint("compile", "add.comp", "--emit", "spirv")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.write("add.spvasm", done.stdout)
        self.run_file(self.write("p.toml", ADD_FILE.replace("SHADER", "add.spvasm")))
        self.assertEqual(self.saved_numbers(), [11, 12, 13, 11])
        if shutil.which("spirv-as"):
            subprocess.run(["spirv-as", "add.spvasm", "-o", "add.spv"], cwd=self.folder, check=True)
            self.run_file(self.write("p.toml", ADD_FILE.replace("SHADER", "add.spv")))
            self.assertEqual(self.saved_numbers(), [11, 12, 13, 11])
        else:
            print("skipped: spirv-as is not installed")

    def test_generators_fill_buffers(self):
        copy = "#version 460\nlayout(local_size_x = 4) in;\nlayout(binding = 0) buffer A { uint a[]; };\nlayout(binding = 1) buffer B { uint b[]; };\n" \
               "void main() { b[gl_GlobalInvocationID.x] = a[gl_GlobalInvocationID.x]; }\n"
        self.write("copy.comp", copy)
        (self.folder / "numbers.bin").write_bytes(struct.pack("<4I", 9, 8, 7, 6))
        seen = []
        for fill, expected in (('init = "iota"\ncount = 4', [0, 1, 2, 3]), ("value = 7\ncount = 4", [7] * 4), ("count = 4", [0] * 4),
                               ("data = [1, 2, 3, 4]", [1, 2, 3, 4]), ('file = "numbers.bin"', [9, 8, 7, 6]),
                               ('init = "random"\nlow = 5\nhigh = 6\ncount = 4\nseed = 3', None)):
            self.run_file(self.write("p.toml", f"[compute]\nshader = 'copy.comp'\n[launch]\ngroups = 1\n[[buffer]]\nbinding = 0\n{fill}\n"
                                               "[[buffer]]\nbinding = 1\ncount = 4\nsave = 'out.csv'\n"))
            seen = self.saved_numbers()
            if expected is not None:
                self.assertEqual(seen, expected)
        self.assertTrue(set(seen) <= {5, 6}, seen)

    def test_a_png_becomes_a_texture(self):
        look = "#version 460\nlayout(local_size_x = 8, local_size_y = 8) in;\nlayout(binding = 0) uniform sampler2D t;\n" \
               "layout(binding = 1, rgba32f) uniform image2D o;\nvoid main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\n" \
               "imageStore(o, p, textureLod(t, (vec2(p) + 0.5) / 128.0, 0.0)); }\n"
        self.write("look.comp", look)
        picture = ROOT / "docs/images/example_hello_triangle.png"
        self.run_file(self.write("p.toml", f"[compute]\nshader = 'look.comp'\n[launch]\ngroups = [16, 16]\n[[image]]\nbinding = 0\nfile = '{picture}'\n"
                                           "filter = 'nearest'\n[[image]]\nbinding = 1\nsave = 'copy.png'\n"))
        self.assertEqual(glint_case.read_png(self.folder / "out/copy.png"), glint_case.read_png(picture))


    def test_float_pictures_keep_every_bit_on_their_way_through_a_pipeline(self):
        self.write("copy.comp", "#version 460\nlayout(local_size_x = 3, local_size_y = 2) in;\nlayout(binding = 0) uniform sampler2D t;\n"
                                "layout(binding = 1, rgba32f) uniform image2D o;\n"
                                "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy); imageStore(o, p, texelFetch(t, p, 0)); }\n")
        numbers = [1e-3 * i - 0.004 + 7.0 * (i % 3) for i in range(18)]
        (self.folder / "in.pfm").write_bytes(b"PF\n3 2\n-1.0\n" + struct.pack("<18f", *numbers))
        for source, saved in (("in.pfm", "one.exr"), ("out/one.exr", "two.pfm")):
            self.write("p.toml", f"[compute]\nshader = 'copy.comp'\n[launch]\ngroups = 1\n[[image]]\nbinding = 0\nfile = '{source}'\n"
                                 f"[[image]]\nbinding = 1\nsize = [3, 2]\nsave = '{saved}'\n")
            done = self.glint("run", "p.toml", "--mode", "functional", "--out", "next")
            self.assertEqual(done.returncode, 0, done.stderr)
            shutil.rmtree(self.folder / "out", ignore_errors=True)
            (self.folder / "next").rename(self.folder / "out")
        self.assertEqual((self.folder / "out/two.pfm").read_bytes(), (self.folder / "in.pfm").read_bytes())

    def test_a_damaged_exr_is_named_with_its_fault(self):
        self.write("p.comp", "#version 460\nlayout(local_size_x = 1) in;\nlayout(binding = 0) uniform sampler2D t;\nlayout(binding = 1) buffer B { vec4 v; };\n"
                             "void main() { v = texelFetch(t, ivec2(0), 0); }\n")
        (self.folder / "bad.exr").write_bytes(b"\x76\x2f\x31\x01\x02\0\0\0channels\0")
        self.write("p.toml", "[compute]\nshader = 'p.comp'\n[launch]\ngroups = 1\n[[image]]\nbinding = 0\nfile = 'bad.exr'\n[[buffer]]\nbinding = 1\ncount = 4\n")
        self.expect(2, ["p.toml:5", "bad.exr", "the header is cut short"], "run", "p.toml", "--out", "out")

    def test_a_gltf_mesh_is_the_triangle_it_holds_moved_by_its_node(self):
        self.copy("hello_triangle")
        corners = struct.pack("<9f", -1.8, -0.7, 0, -0.2, -0.7, 0, -1, 0.8, 0)  # one to the left of the example's
        data = base64.b64encode(corners + struct.pack("<3H", 0, 1, 2)).decode()
        self.write("mesh.gltf", json.dumps({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0, "translation": [1, 0, 0]}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
            "buffers": [{"byteLength": 42, "uri": "data:application/octet-stream;base64," + data}],
            "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 6}],
            "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [-1.8, -0.7, 0], "max": [-0.2, 0.8, 0]},
                          {"bufferView": 1, "componentType": 5123, "count": 3, "type": "SCALAR"}]}))
        file = self.edit(("vertices = [[-0.8, -0.7, 0.0], [0.8, -0.7, 0.0], [0.0, 0.8, 0.0]]", 'file = "mesh.gltf"'))
        done = self.glint("run", file, "--mode", "functional", "--out", "out")
        if "libtinygltf-dev" in done.stderr:
            print("skipped: this Glint was built without libtinygltf-dev")
            return
        self.assertEqual(done.returncode, 0, done.stderr)
        found, wanted = glint_case.read_png(self.folder / "out/picture.png")[2], glint_case.read_png(ROOT / "docs/images/example_hello_triangle.png")[2]
        self.assertLess(sum(abs(a - b) > 1 for a, b in zip(found, wanted)), 3 * 128)  # corners round differently, so some edge pixels differ


class Mistakes(PipelineTest):
    def setUp(self):
        super().setUp()
        self.copy("hello_triangle")

    def refuse(self, parts, *changes):
        self.expect(2, parts, "run", self.edit(*changes), "--mode", "functional", "--out", "out")

    def test_a_missing_binding_names_the_shaders_line(self):
        self.refuse(["nothing is bound to set 0 binding 1", "'picture' at hello.rgen:6"], ("binding = 1\n", "binding = 5\n"))

    def test_a_binding_of_the_wrong_kind_names_both_places(self):
        self.refuse(["edited.toml:25", "'picture' is a [[buffer]], and the shader wants a [[image]]", "hello.rgen:6"],
                    ("[[image]]", "[[buffer]]"), ('save = "picture.png"', "count = 4"))

    def test_an_unknown_key_is_refused_at_its_line_with_the_nearest(self):
        self.refuse(["edited.toml:29:1: error: 'sav' is not a key of an image", "did you mean 'save'?"], ("save =", "sav ="))

    def test_an_unknown_bottom_level_is_refused_with_the_nearest(self):
        self.refuse(["there is no bottom level 'triangel'", "did you mean 'triangle'?"], ('bottom_level = "triangle"', 'bottom_level = "triangel"'))

    def test_a_shader_of_another_stage_is_refused(self):
        self.refuse(["'closest_hit' wants a shader of stage closest_hit", "hello.rmiss"], ("hello.rchit", "hello.rmiss"))

    def test_a_missing_shader_is_refused_at_its_line(self):
        self.refuse(["edited.toml:", "cannot read the shader 'nowhere.rchit'"], ("hello.rchit", "nowhere.rchit"))

    def test_an_index_without_a_vertex_is_refused(self):
        self.refuse(["index 3 is too large: there are 3 vertices"], ("[0.0, 0.8, 0.0]]", "[0.0, 0.8, 0.0]]\nindices = [0, 1, 3]"))

    def test_an_instance_that_no_ray_can_meet_is_refused_at_its_line(self):
        place = 'bottom_level = "triangle"\n'
        self.refuse(["edited.toml:22:1: error: no ray can meet this instance of 'triangle': its transform cannot be inverted in floats"],
                    (place, place + "scale = 0\n"))
        self.refuse(["edited.toml:22:1: error: ", "its transform moves it to infinity"],
                    (place, place + "transform = [1e38, 0, 0, 3.4e38, 0, 1, 0, 0, 0, 0, 1, 0]\n"))

    def test_a_mistake_in_the_mesh_of_a_buffer_is_named_once_with_the_meshs_line(self):
        self.write("bad.obj", "v 0 0 0\nv 1 0 0\nf 1 2 9\n")
        done = self.expect(2, ["bad.obj:3: error: this face names vertex 9"], "run",
                           self.edit(("[[image]]", '[[buffer]]\nset = 0\nbinding = 7\nfile = "bad.obj"\nattribute = "positions"\n[[image]]')), "--out", "out")
        self.assertEqual(done.stderr.count("error:"), 1, done.stderr)

    def test_an_unknown_kind_of_output_is_refused(self):
        self.refuse(["cannot save to 'picture.gif'"], ("picture.png", "picture.gif"))

    def test_every_mistake_is_reported_at_once(self):
        self.refuse(["'sav'", "'triangel'"], ("save =", "sav ="), ('bottom_level = "triangle"', 'bottom_level = "triangel"'))

    def test_a_buffer_below_the_static_layout_names_both_places(self):
        self.write("add.comp", ADD)
        text = ADD_FILE.replace("SHADER", "add.comp").replace("data = { a = [10, 0, 0, 0], b = [1, 2, 3] }", "data = [1, 2]")
        self.expect(2, ["p.toml:5", "has 8 bytes, and the shader's block needs 64", "add.comp:4"], "run", self.write("p.toml", text))

    def test_an_unknown_member_is_refused_with_the_nearest(self):
        self.write("add.comp", ADD.replace("vec4 a;", "vec4 amount;").replace("settings.a", "settings.amount"))
        text = ADD_FILE.replace("SHADER", "add.comp").replace("{ a =", "{ amonut =")
        self.expect(2, ["no member 'amonut'", "did you mean 'amount'?"], "run", self.write("p.toml", text))

    def test_missing_push_constants_are_refused(self):
        self.copy("mandelbrot")
        self.refuse(["[push_constants] is missing", "mandelbrot.comp:6"], ("[push_constants]\ncentre = [-0.6, 0.0]\nwidth = 2.6\n", ""))

    def test_an_unknown_specialisation_constant_is_refused(self):
        self.copy("mandelbrot")
        self.refuse(["no shader has a specialisation constant 'MUST'"], ("MOST =", "MUST ="))

    def test_a_record_without_its_data_is_refused(self):
        self.copy("materials")
        self.refuse(["the record's data have 0 bytes, and the shader's record has 16", "materials.rchit:5"], ("data = { tint = [1.0, 0.4, 0.3], painter = 0 }\n", ""))

    def test_records_that_are_too_long_and_strides_that_are_too_short_are_refused_at_their_lines(self):
        self.copy("materials")
        data = "data = { tint = [1.0, 0.4, 0.3], painter = 0 }"
        self.refuse(["edited.toml:12:1: error: a hit record has 4096 bytes, and with its handle at most 4096 fit"], (data, f"data = {{ u8 = [{'1, ' * 4096}] }}"))
        self.refuse(["edited.toml:3:1: error: the stride of the hit region is 32, and its largest record needs"], ("[raygen]", "[table]\nhit_stride = 32\n[raygen]"))

    def test_integers_in_a_float_image_are_refused(self):
        self.refuse(["format r32_uint, whose texels are u32, and the shader's are f32"], ('save =', 'format = "r32ui"\nsave ='))


if __name__ == "__main__":
    glint_case.main()
