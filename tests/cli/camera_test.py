# Tests the options of `glint run` that move the camera and render a window of a frame.
# SPDX-License-Identifier: Apache-2.0
"""usage: camera_test.py GLINT SOURCE_DIR [SUITE...]"""
import json
import shutil
import struct

from glint_case import ROOT, GlintTest, main

FAST = ["--mode", "functional", "--spp", "1"]


class FrameTest(GlintTest):
    def render(self, out, *arguments):
        done = self.glint("run", *arguments, "--out", out)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done

    def pixels(self, out):
        """Returns width, height and the rows from the top, each of bytes."""
        data = (self.folder / out / "image.pfm").read_bytes()
        kind, size, scale, body = data.split(b"\n", 3)
        width, height = map(int, size.split())
        rows = [body[12 * width * y:12 * width * (y + 1)] for y in range(height)]
        return width, height, rows[::-1]

    def record(self, out):
        return json.loads((self.folder / out / "run.json").read_text())


class Crop(FrameTest):
    def test_a_window_has_the_bits_of_the_whole_frame(self):
        for workload in ("WKND", "CORNELL"):
            for shader in ("pt", "sh", "ao"):
                for mode in ("functional", "timing"):
                    with self.subTest(workload=workload, shader=shader, mode=mode):
                        frame = [workload, "--shader", shader, "--mode", mode, "--spp", "2", "--size", "24x20"]
                        self.render("whole", *frame)
                        self.render("part", *frame, "--crop", "5,3,11,9")
                        width, height, rows = self.pixels("part")
                        self.assertEqual((width, height), (11, 9))
                        self.assertEqual(rows, [row[12 * 5:12 * 16] for row in self.pixels("whole")[2][3:12]])
                        self.assertGreater(len(set(rows)), 1)

    def test_every_layout_of_warps_gives_the_same_window(self):
        self.render("a", "WKND", *FAST, "--size", "40x40", "--crop", "7,1,30,33")
        for layout in ("linear", "tile_8x4", "morton"):
            self.render("b", "WKND", *FAST, "--size", "40x40", "--crop", "7,1,30,33", "--set", f"core.warp_layout={layout}")
            self.assertEqual(self.pixels("a"), self.pixels("b"), layout)

    def test_the_record_and_compare_say_what_was_rendered(self):
        self.render("whole", "WKND", "--size", "16x16", "--spp", "1")
        self.render("part", "WKND", "--size", "16x16", "--spp", "1", "--crop", "4,8,8,4", "--heat")
        run = self.record("part")
        self.assertEqual((run["width"], run["height"], run["crop"]), (8, 4, {"x": 4, "y": 8, "frame_width": 16, "frame_height": 16}))
        self.assertNotIn("crop", self.record("whole"))
        done = self.glint("compare", "whole", "part")
        self.assertEqual(done.returncode, 0, done.stderr)
        for fact in ("width is 16 in A and 8 in B", "crop.y is nothing in A and 8 in B"):
            self.assertIn(fact, done.stdout + done.stderr)
        done = self.glint("model", "part", "-o", "models.csv")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_faults_and_prints_name_the_pixel_of_the_frame(self):
        shaders = self.folder / "shaders"
        shutil.copytree(ROOT / "shaders", shaders)
        raygen = shaders / "path_tracing/raygen.rgen"
        text = raygen.read_text()
        raygen.write_text(text.replace("void main() {", "#extension GL_EXT_debug_printf : require\nvoid main() {\n  debugPrintfEXT(\"%u %u of %u\", gl_LaunchIDEXT.x, "
                                       "gl_LaunchIDEXT.y, gl_LaunchSizeEXT.x);", 1))
        self.render("out", "WKND", *FAST, "--size", "16x12", "--crop", "14,10,2,2", "--shader-dir", shaders / "path_tracing")
        self.assertEqual((self.folder / "out/printf.txt").read_text().split("\n")[:4], ["14 10 of 16", "15 10 of 16", "14 11 of 16", "15 11 of 16"])

    def test_windows_that_are_none_or_leave_the_frame_are_refused(self):
        for text in ("1,2,3", "1,2,3,4,5", "1,2,3,", "a,0,1,1", "0,0,0,1", "-1,0,1,1", "0,0,1,1,", ",,,", "1.5,0,1,1", "999999,0,1,1"):
            self.expect(2, ["--crop", "X,Y,WIDTH,HEIGHT"], "run", "WKND", f"--crop={text}")
        for text in ("0,0,129,1", "128,0,1,1", "100,100,29,1", "0,100,1,29"):
            self.expect(2, [f"--crop is '{text}'", "128x128"], "run", "WKND", "--crop", text)
        self.expect(2, ["--crop belongs to scenes"], "run", ROOT / "examples/mandelbrot/pipeline.toml", "--crop", "0,0,1,1")

    def test_bench_renders_the_window_of_every_workload(self):
        done = self.glint("bench", "WKND_PT", "WKND_AO", "--size", "16x16", "--spp", "1", "--mode", "functional", "--crop", "2,2,4,4", "--out", "b")
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("WKND_PT", "WKND_AO"):
            self.assertEqual(self.record(f"b/{name}")["crop"], {"x": 2, "y": 2, "frame_width": 16, "frame_height": 16})

    def test_bench_changes_camera_light_and_material_of_every_workload_as_run_does(self):
        changes = ["--fov", "30", "--eye", "278,278,700", "--light", "position=200,400,100", "--light", "radius=5", "--material", "left_wall.diffuse=0,0,1"]
        frame = ["--size", "8x8", "--spp", "1", "--mode", "functional"]
        done = self.glint("bench", "BUNNY_SH", "BUNNY_AO", *frame, *changes[:4], "--light", "sky=on", "--material", "left_wall.diffuse=0,0,1", "--out", "b")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.render("one", "BUNNY_SH", *frame, *changes[:4], "--light", "sky=on", "--material", "left_wall.diffuse=0,0,1")
        self.assertEqual(self.pixels("b/BUNNY_SH"), self.pixels("one"))
        self.assertEqual(self.record("b/BUNNY_AO")["overrides"], self.record("one")["overrides"])
        again = [part for change in ("30", "31") for part in [self.glint("bench", "BUNNY_SH", *frame, "--fov", change, "--out", "c", "--resume").stdout]]
        self.assertNotIn("1 of them complete", again[1])
        self.expect(2, ["--material is 'diffuse=1,1,1'", "NAME.KEY=VALUE"], "bench", "BUNNY_SH", *frame, "--material", "diffuse=1,1,1", "--out", "d")


OBJ = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nf 1 2 3 4\n"


class Camera(FrameTest):
    def test_the_camera_stands_where_the_options_say(self):
        self.write("square.obj", OBJ)

        def covered(*camera):
            """Returns the box of the pixels that see the square, which trace rays of occlusion, too."""
            self.render("out", "square.obj", "--shader", "ao", *FAST, "--size", "32x32", "--heat", *camera)
            counts = struct.unpack("<1024I", (self.folder / "out/heat/rays.npy").read_bytes()[-4096:])
            seen = [(i % 32, i // 32) for i, count in enumerate(counts) if count > 1]
            return min(x for x, _ in seen), min(y for _, y in seen), max(x for x, _ in seen), max(y for _, y in seen)
        # At distance 4 the square of edge 2 spans 2 atan(1/4) = 28.07 degrees, and half the picture at tan(fov/2) = 1/2.
        self.assertEqual(covered("--eye", "0,0,4", "--look-at", "0,0,0", "--up", "0,1,0", "--fov", "53.13010235"), (8, 8, 23, 23))
        self.assertEqual(covered("--eye", "0,0,4", "--look-at", "1,0,0", "--up", "0,1,0", "--fov", "53.13010235")[0::2], (0, 15))
        narrow = covered("--eye", "0,0,8", "--look-at", "0,0,0", "--up", "0,1,0", "--fov", "53.13010235")
        self.assertEqual(narrow, (12, 12, 19, 19))

    def test_the_record_has_the_camera_and_compare_warns(self):
        self.render("a", "WKND", "--size", "8x8", "--spp", "1")
        self.render("b", "WKND", "--size", "8x8", "--spp", "1", "--fov", "35", "--eye=-5,2,3")
        self.assertEqual(self.record("b")["overrides"], {"camera.eye": "-5,2,3", "camera.fov": "35"})
        self.assertNotIn("overrides", self.record("a"))
        done = self.glint("compare", "a", "b")
        self.assertIn("overrides.camera.fov is nothing in A and 35 in B", done.stdout + done.stderr)
        done = self.glint("model", "b", "-o", "models.csv")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_the_scenes_own_camera_changes_nothing(self):
        self.render("a", "CORNELL", *FAST, "--size", "8x8")
        self.render("b", "CORNELL", *FAST, "--size", "8x8", "--up", "0,2,0")
        self.assertEqual(self.pixels("a"), self.pixels("b"))

    def test_cameras_that_cannot_be_are_refused(self):
        for option in ("--eye", "--look-at", "--up"):
            for text in ("1,2", "1,2,3,4", "1,2,x", "nan,0,0", "inf,0,0", "1e10,0,0", "1,2,3,"):
                self.expect(2, [f"{option} is '{text}'", "X,Y,Z"], "run", "WKND", f"{option}={text}")
        for text in ("0", "180", "-5", "x", "1,2", "nan"):
            self.expect(2, [f"--fov is '{text}'", "above 0 and below 180"], "run", "WKND", f"--fov={text}")
        self.expect(2, ["looks at its own place"], "run", "WKND", "--eye", "1,1,1", "--look-at", "1,1,1")
        self.expect(2, ["--up"], "run", "WKND", "--eye", "0,5,0", "--look-at", "0,0,0")
        self.expect(2, ["--up"], "run", "WKND", "--up", "0,0,0")
        self.expect(2, ["--eye belongs to scenes"], "run", ROOT / "examples/mandelbrot/pipeline.toml", "--eye", "0,0,1")


class Overrides(FrameTest):
    def listed(self, scene):
        """Returns the rows of `glint list materials` by number."""
        done = self.glint("list", "materials", scene)
        self.assertEqual(done.returncode, 0, done.stderr)
        return done.stdout

    def test_a_material_becomes_what_the_file_could_have_said(self):
        names = "mtllib {}\n" + OBJ.replace("f 1 2 3 4", "usemtl wood.001\nf 1 2 3\nusemtl b\nf 1 3 4")
        self.write("a.mtl", "newmtl wood.001\nKd 0.5 0.5 0.5\nnewmtl b\nKd 0.25 0.5 0.75\n")
        self.write("z.mtl", "newmtl wood.001\nKd 1 0.25 0\nnewmtl b\nKd 0.5 0 1\n")
        self.write("a.obj", names.format("a.mtl"))
        (self.folder / "other").mkdir()
        self.write("other/a.obj", names.format("z.mtl"))
        shutil.copy(self.folder / "z.mtl", self.folder / "other/z.mtl")
        self.assertRegex(self.listed("a.obj"), r"0 +wood\.001 +lambertian +0\.5,0\.5,0\.5")
        self.render("wanted", "other/a.obj", *FAST, "--size", "8x8")
        self.render("got", "a.obj", *FAST, "--size", "8x8", "--material", "wood.001.diffuse=1,0.25,0", "--material", "1.diffuse=0.5,0,1")
        self.assertEqual(self.pixels("got"), self.pixels("wanted"))
        self.assertEqual(self.record("got")["scene"]["hash"], self.record("wanted")["scene"]["hash"])
        self.assertEqual(self.record("got")["overrides"], {"material.wood.001.diffuse": "1,0.25,0", "material.1.diffuse": "0.5,0,1"})

    def test_compare_knows_overrides_of_names_with_dots(self):
        self.write("a.mtl", "newmtl wood.001\nKd 0.5 0.5 0.5\n")
        self.write("a.obj", "mtllib a.mtl\nusemtl wood.001\n" + OBJ)
        self.render("a", "a.obj", "--size", "8x8", "--spp", "1")
        self.render("b", "a.obj", "--size", "8x8", "--spp", "1", "--material", "wood.001.model=metallic", "--light", "sky=off", "--light", "position=0,9,3")
        self.assertIn("overrides.material.wood.001.model is nothing in A and metallic in B", (lambda d: d.stdout + d.stderr)(self.glint("compare", "a", "b")))

    def test_materials_of_generated_scenes_have_names(self):
        for scene, rows in (("CORNELL", ["0 +right_wall ", "3 +light "]), ("WKND", ["0 +ground ", "1 +sphere_1 ", "484 +large_glass "]), ("SHIP", ["1 +sail "]), ("FOX", ["0 +fur "])):
            for row in rows:
                self.assertRegex(self.listed(scene), f"(?m)^{row}", scene)
        self.render("a", "CORNELL", *FAST, "--size", "8x8", "--material", "white.diffuse=0.1,0.2,0.3")
        self.render("b", "CORNELL", *FAST, "--size", "8x8", "--material", "2.diffuse=0.1,0.2,0.3")
        self.assertEqual(self.pixels("a"), self.pixels("b"))

    def test_model_repeats_a_run_with_other_materials(self):
        self.render("a", "CORNELL", "--size", "8x8", "--spp", "1", "--material", "2.model=metallic", "--material", "2.fuzziness=0.5")
        done = self.glint("model", "a", "-o", "models.csv")
        self.assertEqual(done.returncode, 0, done.stderr)

    def test_a_light_without_a_sky_moves_shadows(self):
        for out, place in (("a", "278,500,200"), ("b", "278,-500,400")):
            self.render(out, "CORNELL", "--shader", "sh", *FAST, "--size", "16x16", "--light", f"position={place}")
        self.assertTrue(self.pixels("a") != self.pixels("b"))

    def test_what_no_scene_has_is_refused(self):
        for text, parts in (("9.diffuse=1,1,1", ["there is no material '9'", "glint list materials"]), ("floor.diffuse=1,1,1", ["there is no material 'floor'"]),
                            ("0.diffuse=1,1", ["--material 0.diffuse is '1,1'", "R,G,B"]), ("0.model=wood", ["lambertian"]), ("0.fuzziness=2", ["0 to 1"]),
                            ("0.refraction_index=0", ["1 to 100"]), ("0.texture=99", ["number of a texture"]), ("0.texture=0.5", ["number of a texture"]), ("0.colour=1", ["the keys are"]),
                            ("diffuse=1,1,1", ["NAME.KEY=VALUE"]), ("0.diffuse=nan,1,1", ["R,G,B"]), ("-1.diffuse=1,1,1", ["there is no material"])):
            self.expect(2, parts, "run", "CORNELL", f"--material={text}")
        for text, parts in (("sky=maybe", ["on or off"]), ("position=1,2", ["X,Y,Z"]), ("radius=-1", ["length"]), ("colour=1", ["a light has no 'colour'"]), ("sky", ["KEY=VALUE"])):
            self.expect(2, parts, "run", "CORNELL", f"--light={text}")
        self.expect(2, ["WKND has a sky", "--light sky=off"], "run", "WKND", "--light", "radius=2")
        self.expect(2, ["--material belongs to scenes"], "run", ROOT / "examples/mandelbrot/pipeline.toml", "--material", "0.diffuse=1,1,1")
        self.expect(2, ["which scene"], "list", "materials")
        self.expect(2, ["'WKND' goes with materials"], "list", "scenes", "WKND")


if __name__ == "__main__":
    main()
