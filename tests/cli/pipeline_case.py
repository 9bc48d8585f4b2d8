# Shares with the tests of pipeline files: a small shader, the examples, and files made of them.
# SPDX-License-Identifier: Apache-2.0
import shutil

from glint_case import ROOT, GlintTest

PICTURES = ["mandelbrot", "hello_triangle", "spheres", "cutout", "materials", "ambient_occlusion", "reordering", "denoise", "temporal"]
ADD = """#version 460
layout(local_size_x = 4) in;
layout(constant_id = 3) const int FACTOR = 1;
layout(set = 1, binding = 2, std140) uniform Settings { vec4 a; float b[3]; } settings;
layout(set = 0, binding = 0) buffer Out { float result[]; };
void main() { result[gl_GlobalInvocationID.x] = FACTOR * (settings.a.x + settings.b[gl_GlobalInvocationID.x % 3]); }
"""


class PipelineTest(GlintTest):
    def run_file(self, what, *arguments):
        done = self.glint("run", what, "--mode", "functional", "--out", "out", *arguments)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        return done

    def copy(self, example):
        shutil.copytree(ROOT / "examples" / example, self.folder, dirs_exist_ok=True)

    def edit(self, *changes):
        """Returns the example's file with texts replaced, each of which must exist."""
        text = (self.folder / "pipeline.toml").read_text()
        for old, new in changes:
            self.assertIn(old, text)
            text = text.replace(old, new, 1)
        return self.write("edited.toml", text)
