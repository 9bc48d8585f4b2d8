# Tests rules of ray tracing, and inputs and outputs of pipeline files, on scenes that a file describes, with the real binary on both machines.
# SPDX-License-Identifier: Apache-2.0
"""usage: rules_test.py GLINT SOURCE_DIR [SUITE...]"""
import json
import struct

import glint_case
from glint_case import GlintTest

UNTOUCHED, MISS = (-9, -9, -9, -9), (-1, -1, -1, -1)
FRONT, BACK = 254, 255

HEAD = "#version 460\n#extension GL_EXT_ray_tracing : require\n"
SHADERS = {
    "probe.rgen": HEAD + """layout(set = 0, binding = 0) uniform accelerationStructureEXT scene;
layout(set = 0, binding = 1, std430) buffer Found { float found[]; };
layout(set = 0, binding = 2, std430) readonly buffer Rays { vec4 rays[]; };
layout(push_constant) uniform Push { uint flags, mask, offset, stride, miss; } push;
layout(location = 0) rayPayloadEXT vec4 payload;
void main() {
  const uint i = gl_LaunchIDEXT.x;
  payload = vec4(-9.0);
  traceRayEXT(scene, push.flags, push.mask, push.offset, push.stride, push.miss, rays[2 * i].xyz, rays[2 * i].w, rays[2 * i + 1].xyz, rays[2 * i + 1].w, 0);
  for (int k = 0; k < 4; ++k) found[4 * i + k] = payload[k];
}
""",
    "probe.rmiss": HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload = vec4(-1.0); }\n",
    "other.rmiss": HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload = vec4(-2.0); }\n",
    "probe.rchit": HEAD + """layout(location = 0) rayPayloadInEXT vec4 payload;
layout(shaderRecordEXT) buffer Record { float tag; } record;
void main() { payload = vec4(gl_HitTEXT, gl_HitKindEXT, gl_InstanceID * 100 + gl_GeometryIndexEXT * 10 + gl_PrimitiveID, record.tag); }
""",
    "drop.rahit": HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload.x = -5.0; ignoreIntersectionEXT; }\n",
    "numbers.rchit": HEAD + "layout(location = 0) rayPayloadInEXT Mixed { vec2 first; uvec2 last; } payload;\nvoid main() { payload.last.x = 1u; }\n",
    "large.rchit": HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload[2];\nvoid main() { payload[1] = vec4(1.0); }\n",
}
DOWN = ((0, 0, 1), (0, 0, -1))  # meets the triangle at 1
# It is clockwise, seen from above in the left-handed space of Vulkan's rule.
TRIANGLE = "vertices = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]]"
LEVEL = '[[bottom_level]]\nname = "{name}"\n[[bottom_level.geometry]]\n{geometry}\n'
FILTER = '[machine]\nset = ["rt.leaf_filter=micromaps"]\n'
HIT = '[[hit]]\nclosest_hit = "probe.rchit"\ndata = {{ tag = {tag} }}\n'


class RulesTest(GlintTest):
    def setUp(self):
        super().setUp()
        for name, text in SHADERS.items():
            self.write(name, text)

    def glint(self, file, mode="functional", code=0):
        done = super().glint("run", file, "--mode", mode, "--out", "out")
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def shoot(self, instances="", flags=0, mask=255, offset=0, stride=0, miss=0, ray=DOWN, ends=((0, 100),), hits=HIT.format(tag=7), geometry=TRIANGLE, more="", table=""):
        """Returns what the payload holds after each ray: (t, kind, 100 instance + 10 geometry + primitive, the record's tag)."""
        rays = ", ".join(f"{v}" for low, high in ends for v in (*ray[0], low, *ray[1], high))
        text = f'[raygen]\nshader = "probe.rgen"\n[[miss]]\nshader = "probe.rmiss"\n[[miss]]\nshader = "other.rmiss"\n{hits}[launch]\nsize = [{len(ends)}]\n{table}' \
               f'[push_constants]\nflags = {flags}\nmask = {mask}\noffset = {offset}\nstride = {stride}\nmiss = {miss}\n' \
               f'{LEVEL.format(name="mesh", geometry=geometry)}{more}[[top_level]]\nbinding = 0\n' \
               f'{instances or instance()}[[buffer]]\nbinding = 1\ntype = "f32"\ncount = {4 * len(ends)}\nsave = "out.csv"\n' \
               f'[[buffer]]\nbinding = 2\ntype = "f32"\ndata = [{rays}]\n'
        seen = []
        for mode in ("functional", "timing"):
            self.log = self.glint(self.write("p.toml", text), mode)
            words = self.saved_numbers()
            seen.append([tuple(words[i:i + 4]) for i in range(0, len(words), 4)])
        self.assertEqual(seen[0], seen[1])
        return seen[0]


def instance(more="", level="mesh"):
    return f'[[top_level.instance]]\nbottom_level = "{level}"\n{more}\n'


class Rays(RulesTest):
    def test_a_triangle_at_either_end_of_the_ray_is_not_hit(self):
        self.assertEqual(self.shoot(ends=((0, 1), (1, 2), (0.5, 1.5), (0, 0.5))), [MISS, MISS, (1, FRONT, 0, 7), MISS])

    def test_flags_of_ray_and_instance_decide_about_facing(self):
        turned = "vertices = [[-1, -1, 0], [0, 1, 0], [1, -1, 0]]"
        mirror = "transform = [-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0]"
        flip, disable = 'flags = ["flip_facing"]', 'flags = ["facing_cull_disable"]'
        for geometry, more, kind in ((TRIANGLE, "", FRONT), (turned, "", BACK), (TRIANGLE, flip, BACK), (turned, mirror, BACK), (TRIANGLE, disable, FRONT)):
            for flags, culled in ((0, None), (0x10, BACK), (0x20, FRONT)):
                with self.subTest(kind=kind, more=more, flags=flags):
                    hit = (1, kind, 0, 7)
                    gone = culled == kind and more != disable
                    self.assertEqual(self.shoot(instance(more), flags, geometry=geometry), [MISS if gone else hit])

    def test_an_instance_is_seen_when_its_mask_shares_a_bit_with_the_rays(self):
        both = instance("mask = 2\ncustom_index = 5") + instance("mask = 4\ntranslate = [0, 0, -1]")
        for mask, found in ((255, (1, FRONT, 0, 7)), (4, (2, FRONT, 100, 7)), (6, (1, FRONT, 0, 7)), (1, MISS), (0x102, (1, FRONT, 0, 7)), (0, MISS)):
            with self.subTest(mask=mask):
                self.assertEqual(self.shoot(both, mask=mask), [found])

    def test_opacity_comes_from_the_ray_then_the_instance_then_the_geometry(self):
        hits = '[[hit]]\nclosest_hit = "probe.rchit"\nany_hit = "drop.rahit"\ndata = { tag = 7 }\n'
        for opaque, instance_flag, flags, is_opaque in (
                (True, "", 0, True), (False, "", 0, False), (True, "force_no_opaque", 0, False), (False, "force_opaque", 0, True),
                (True, "", 2, False), (False, "force_no_opaque", 1, True), (True, "force_opaque", 2, False)):
            with self.subTest(opaque=opaque, instance=instance_flag, flags=flags):
                more = f'flags = ["{instance_flag}"]' if instance_flag else ""
                geometry = f"{TRIANGLE}\nopaque = {str(opaque).lower()}"
                self.assertEqual(self.shoot(instance(more), flags, hits=hits, geometry=geometry)[0][0], 1 if is_opaque else -1)
                culled = 0x40 if is_opaque else 0x80
                self.assertEqual(self.shoot(instance(more), flags | culled, hits=hits, geometry=geometry), [MISS])

    def test_what_an_any_hit_shader_wrote_stays_when_it_ignores(self):
        self.write("probe.rmiss", HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload.y = -1.0; }\n")
        self.assertEqual(self.shoot(hits='[[hit]]\nany_hit = "drop.rahit"\n', geometry=TRIANGLE + "\nopaque = false"), [(-5, -1, -9, -9)])

    def test_a_skipped_or_missing_closest_hit_shader_leaves_the_payload(self):
        self.assertEqual(self.shoot(flags=8, ends=((0, 100), (5, 100))), [UNTOUCHED, MISS])
        self.assertEqual(self.shoot(flags=13, ends=((0, 100), (5, 100))), [UNTOUCHED, MISS])
        self.assertEqual(self.shoot(hits="[[hit]]\n"), [UNTOUCHED])

    def opacity(self, keys, flags=0, more="", at=(0, -0.3)):
        """Returns what became of a ray through a triangle with these keys: "miss", "hit", or "asked" where its any-hit shader ran."""
        self.write("probe.rmiss", HEAD + "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload.y = -1.0; }\n")
        (seen,) = self.shoot(instance(more), flags, hits='[[hit]]\nclosest_hit = "probe.rchit"\nany_hit = "drop.rahit"\ndata = { tag = 7 }\n',
                             geometry=TRIANGLE + "\nopaque = false\n" + keys, more=FILTER, ray=((*at, 1), (0, 0, -1)))
        return {-9: "miss", -5: "asked", 1: "hit"}[seen[0]]

    def test_opacity_maps_decide_parts_of_a_triangle_and_flags_force_2_states(self):
        # The parts of level 1 are those at corner 0, in the middle, at corner 1 and at corner 2.
        for part, at in enumerate(((-0.7, -0.8), (0, -0.3), (0.7, -0.8), (0, 0.7))):
            digits = "".join("1" if i == part else "0" for i in range(4))
            self.assertEqual(self.opacity(f'opacity_maps = ["{digits}"]', at=at), "hit")
            digits = digits.replace("1", "2").replace("0", "1")
            self.assertEqual(self.opacity(f'opacity_maps = ["{digits}"]', at=at), "asked")
        for map, state, forced in (("0", "miss", "miss"), ("1", "hit", "hit"), ("1201", "asked", "miss"), ("1301", "asked", "hit")):
            keys = f'opacity_maps = ["{map}"]'
            self.assertEqual(self.opacity(keys), state)
            self.assertEqual(self.opacity(keys, flags=1024), forced)  # gl_RayFlagsForceOpacityMicromap2StateEXT
            self.assertEqual(self.opacity(keys, more='flags = ["force_opacity_2_states"]'), forced)
            self.assertEqual(self.opacity(keys, more='flags = ["disable_opacity_maps"]'), "asked")
        for index, state in (("-1", "miss"), ("-2", "hit"), ("-3", "asked"), ("-4", "asked"), ("1", "hit")):
            self.assertEqual(self.opacity(f'opacity_maps = ["{"0" * 4096}", "{"1" * 16}"]\nopacity_index = [{index}]'), state)

    def test_opacity_maps_that_cannot_be_are_refused(self):
        boxes = "aabbs = [[0, 0, 0, 1, 1, 1]]"
        for geometry, filter, told in ((TRIANGLE + '\nopacity_maps = ["012"]', FILTER, "'012' is no map: it has 3 characters"),
                                       (TRIANGLE + '\nopacity_maps = ["014x"]', FILTER, "'014x' is no map"),
                                       (TRIANGLE + '\nopacity_maps = [""]', FILTER, "'' is no map"),
                                       (TRIANGLE + f'\nopacity_maps = ["{"0" * 16384}"]', FILTER, "is no map: it has 16384 characters"),
                                       (TRIANGLE + '\nopacity_maps = ["1"]\nopacity_index = [1]', FILTER, "1 names no map: there are 1 maps"),
                                       (TRIANGLE + "\nopacity_index = [-5]", FILTER, "-5 names no map"),
                                       (TRIANGLE + '\nopacity_maps = ["1", "0"]', FILTER, "those of 2 triangles, and the geometry has 1"),
                                       (TRIANGLE + '\nopacity_maps = ["1"]', "", 'rt.leaf_filter = "none" asks none'),
                                       (boxes + '\nopacity_maps = ["1"]', FILTER, "boxes have no opacity maps")):
            text = f'[raygen]\nshader = "probe.rgen"\n[[miss]]\nshader = "probe.rmiss"\n{HIT.format(tag=7)}[launch]\nsize = [1]\n' \
                   "[push_constants]\ndata = [0, 0, 0, 0, 0]\n" + LEVEL.format(name="mesh", geometry=geometry) + filter + \
                   "[[top_level]]\nbinding = 0\n" + instance() + '[[buffer]]\nbinding = 1\ntype = "f32"\ncount = 4\n' \
                   '[[buffer]]\nbinding = 2\ntype = "f32"\ndata = [0, 0, 1, 0, 0, 0, -1, 100]\n'
            done = self.glint(self.write("p.toml", text), code=2)
            self.assertIn(told, done.stderr)

    def test_triangles_without_area_are_never_hit(self):
        for geometry in ("vertices = [[-1, 0, 0], [1, 0, 0], [0, 0, 0]]", "vertices = [[0, 0, 0], [0, 0, 0], [0, 0, 0]]", "vertices = [[-1, -1, 0], [1, 1, 0], [-1, -1, 0]]"):
            with self.subTest(geometry=geometry):
                self.assertEqual(self.shoot(geometry=geometry), [MISS])

    def test_the_hit_record_is_that_of_instance_geometry_and_trace(self):
        hits = "".join(HIT.format(tag=10 + i) for i in range(8))
        two = TRIANGLE + "\n[[bottom_level.geometry]]\n" + TRIANGLE.replace(", 0]", ", 0.25]")
        for offset, stride, base, record in ((0, 0, 0, 0), (1, 0, 0, 1), (1, 2, 0, 3), (0, 1, 4, 5), (16, 17, 2, 3), (1, 2, 4, 7)):
            with self.subTest(offset=offset, stride=stride, base=base):
                found = self.shoot(instance(f"sbt_offset = {base}"), offset=offset, stride=stride, hits=hits, geometry=two)
                self.assertEqual(found, [(0.75, FRONT, 10, 10 + record)])
        found = self.shoot(instance("sbt_offset = 3"), offset=2, stride=1, hits=hits, geometry=two, table="[table]\nhit_stride = 0\n")
        self.assertEqual(found, [(0.75, FRONT, 10, 10)])  # a stride of 0 means the first record, whatever the index

    def test_the_miss_record_is_that_of_the_low_16_bits(self):
        beside = ((5, 5, 1), (0, 0, -1))
        self.assertEqual(self.shoot(ray=beside, miss=1), [(-2, -2, -2, -2)])
        self.assertEqual(self.shoot(ray=beside, miss=0x50000), [MISS])

    def test_equal_distances_go_to_the_lowest_instance_and_primitive(self):
        twice = "vertices = [[-1, -1, 0], [1, -1, 0], [0, 1, 0], [-1, -1, 0], [1, -1, 0], [0, 1, 0]]\nindices = [3, 4, 5, 0, 1, 2]"
        self.assertEqual(self.shoot(instance() + instance(), geometry=twice), [(1, FRONT, 0, 7)])

    def test_a_payload_that_no_trace_hands_over_is_told(self):
        self.shoot(hits='[[hit]]\nclosest_hit = "probe.rchit"\ndata = { tag = 7 }\n[[hit]]\nclosest_hit = "large.rchit"\n')
        self.assertIn("large.rchit: note: the shader reads a payload of 32 bytes, and the largest that any shader here hands to a trace has 16", self.log.stderr)
        self.shoot(hits='[[hit]]\nclosest_hit = "probe.rchit"\ndata = { tag = 7 }\n[[hit]]\nclosest_hit = "numbers.rchit"\n')
        self.assertIn("numbers.rchit: note: scalar 3 of the payload that the shader reads is an integer of 32 bits, and the most similar payload that a shader here "
                      "hands to a trace has a float of 32 bits there", self.log.stderr)
        self.shoot()
        self.assertNotIn("payload", self.log.stderr)


def glb(corners):
    """Returns a binary glTF file of one triangle list."""
    data = struct.pack(f"<{len(corners)}f", *corners)
    text = json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                       "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"byteLength": len(data)}],
                       "bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": len(data)}],
                       "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(corners) // 3, "type": "VEC3",
                                      "min": [min(corners[i::3]) for i in range(3)], "max": [max(corners[i::3]) for i in range(3)]}]}).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(data), b"BIN\0") + data
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


class Files(RulesTest):
    def test_a_glb_mesh_is_the_triangles_it_holds(self):
        (self.folder / "mesh.glb").write_bytes(glb([-1, -1, 0.25, 1, -1, 0.25, 0, 1, 0.25]))
        try:
            found = self.shoot(geometry='file = "mesh.glb"')
        except AssertionError as error:
            if "libtinygltf-dev" not in str(error):
                raise
            print("skipped: this Glint was built without libtinygltf-dev")
            return
        self.assertEqual(found, [(0.75, FRONT, 0, 7)])

    def test_an_hdr_picture_keeps_numbers_above_1_and_goes_out_as_pfm_raw_npy_and_csv(self):
        # The Radiance file has 4 x 1 flat pixels of shared exponent, of 128 * 2^(e - 136) each.
        texels = bytes([128, 64, 32, 129, 128, 128, 128, 133, 255, 0, 0, 128, 0, 0, 0, 0])
        (self.folder / "sky.hdr").write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 4\n" + texels)
        look = "#version 460\nlayout(local_size_x = 4) in;\nlayout(binding = 0) uniform sampler2D t;\nlayout(binding = 1, rgba32f) uniform image2D o;\n" \
               "void main() { ivec2 p = ivec2(gl_GlobalInvocationID.xy);\nimageStore(o, p, texelFetch(t, p, 0)); }\n"
        self.write("look.comp", look)
        red = [1.0, 16.0, 255 / 256, 0.0]
        for name in ("sky.pfm", "sky.raw", "sky.npy", "sky.csv"):
            self.glint(self.write("p.toml", f"[compute]\nshader = 'look.comp'\n[launch]\ngroups = [1]\n[[image]]\nbinding = 0\nfile = 'sky.hdr'\n"
                                            f"[[image]]\nbinding = 1\nsize = [4, 1]\nsave = '{name}'\n"))
            data = (self.folder / "out" / name).read_bytes()
            if name.endswith(".pfm"):
                head = data.split(b"\n", 3)
                self.assertEqual((head[0], head[1].split()), (b"PF", [b"4", b"1"]))
                order = "<" if float(head[2]) < 0 else ">"
                self.assertEqual(list(struct.unpack(order + "12f", head[3]))[::3], red)
            elif name.endswith(".raw"):
                self.assertEqual(list(struct.unpack("<16f", data))[::4], red)
            elif name.endswith(".npy"):
                self.assertIn(b"'shape': (1, 4, 4)", data[:128])
                self.assertEqual(list(struct.unpack("<16f", data[-64:]))[::4], red)
            else:
                rows = [line.split(",") for line in data.decode().split()]
                self.assertEqual(rows[0], ["x", "y", "red", "green", "blue", "alpha"])
                self.assertEqual([float(row[2]) for row in rows[1:]], red)

    def test_boxes_with_an_intersection_shader_are_met_with_both_ends_of_the_ray_closed(self):
        self.write("box.rint", HEAD + "hitAttributeEXT vec2 unused;\nvoid main() { unused = vec2(0.0); reportIntersectionEXT(gl_PrimitiveID == 0 ? 1.0 : 2.0, 33u); }\n")
        hits = '[[hit]]\nclosest_hit = "probe.rchit"\nintersection = "box.rint"\ndata = { tag = 7 }\n'
        boxes = "aabbs = [[-1, -1, -0.5, 1, 1, 0.5], [-1, -1, -2, 1, 1, -1]]"
        found = self.shoot(hits=hits, geometry=boxes, ends=((0, 100), (1, 100), (0, 1), (1.25, 100), (0, 0.75), (1.25, 2)))
        self.assertEqual(found, [(1, 33, 0, 7), (1, 33, 0, 7), (1, 33, 0, 7), (2, 33, 1, 7), MISS, (2, 33, 1, 7)])

    def test_specialisation_and_push_constants_reach_every_stage(self):
        self.write("probe.rchit", HEAD + "layout(constant_id = 2) const float SCALE = 1.0;\nlayout(push_constant) uniform Push { uint flags, mask, offset, stride, miss; } push;\n"
                                         "layout(location = 0) rayPayloadInEXT vec4 payload;\nvoid main() { payload = vec4(SCALE, push.mask, push.miss, 0.0); }\n")
        hits = '[[hit]]\nclosest_hit = "probe.rchit"\n[specialization]\nSCALE = 2.5\n'
        self.assertEqual(self.shoot(hits=hits, mask=9, miss=1), [(2.5, 9, 1, 0)])

    def test_an_array_of_buffers_has_an_element_a_table(self):
        self.write("sum.comp", "#version 460\n#extension GL_EXT_nonuniform_qualifier : require\nlayout(local_size_x = 4) in;\n"
                               "layout(binding = 0) readonly buffer In { uint x[]; } source[3];\nlayout(binding = 1) buffer Out { uint y[]; };\n"
                               "void main() { const uint i = gl_GlobalInvocationID.x; y[i] = source[nonuniformEXT(i % 3)].x[i] + 1000 * source[nonuniformEXT(i % 3)].x.length(); }\n")
        tables = "".join(f"[[buffer]]\nbinding = 0\nelement = {e}\ndata = [{', '.join(str(10 * e + k) for k in range(4 + e))}]\n" for e in range(3))
        text = f"[compute]\nshader = 'sum.comp'\n[launch]\ngroups = 1\n{tables}[[buffer]]\nbinding = 1\ncount = 4\nsave = 'out.csv'\n"
        self.glint(self.write("p.toml", text))
        self.assertEqual(self.saved_numbers(), [4000, 5011, 6022, 4003])
        done = self.glint(self.write("p.toml", text.replace("element = 1\n", "element = 3\n")), code=2)
        self.assertIn("element 3 of set 0 binding 0: the shader's array has 3", done.stderr)
        self.assertIn("sum.comp:4", done.stderr)

    def test_a_buffer_goes_out_as_raw_npy_and_csv_with_its_type(self):
        self.write("count.comp", "#version 460\nlayout(local_size_x = 4) in;\nlayout(binding = 0) buffer Out { int y[]; };\nvoid main() { y[gl_GlobalInvocationID.x] = int(gl_GlobalInvocationID.x) - 2; }\n")
        for name in ("y.raw", "y.npy", "y.csv"):
            self.glint(self.write("p.toml", f"[compute]\nshader = 'count.comp'\n[launch]\ngroups = 1\n[[buffer]]\nbinding = 0\ntype = 's32'\ncount = 4\nsave = '{name}'\n"))
            data = (self.folder / "out" / name).read_bytes()
            if name == "y.csv":
                self.assertEqual(self.saved_numbers(name), [-2, -1, 0, 1])
            else:
                self.assertEqual(struct.unpack("<4i", data[-16:]), (-2, -1, 0, 1))
                self.assertEqual(len(data) == 16, name == "y.raw")
            if name == "y.npy":
                self.assertIn(b"'descr': '<i4'", data[:128])

    def test_a_structure_where_a_buffer_is_wanted_and_the_other_way_round_name_both_places(self):
        text = '[raygen]\nshader = "probe.rgen"\n[[miss]]\nshader = "probe.rmiss"\n[[hit]]\nclosest_hit = "probe.rchit"\ndata = { tag = 1 }\n[launch]\nsize = [1]\n' \
               "[push_constants]\ndata = [0, 0, 0, 0, 0]\n" + LEVEL.format(name="mesh", geometry=TRIANGLE) + \
               f"[[top_level]]\nbinding = 2\n{instance()}[[buffer]]\nbinding = 0\ncount = 4\n[[image]]\nbinding = 1\n"
        done = self.glint(self.write("p.toml", text), code=2)
        for part in ("is a [[buffer]], and the shader wants a [[top_level]]", "is a [[top_level]], and the shader wants a [[buffer]]",
                     "is a [[image]], and the shader wants a [[buffer]]", "probe.rgen:3", "probe.rgen:4", "probe.rgen:5", "p.toml:"):
            self.assertIn(part, done.stderr)


if __name__ == "__main__":
    glint_case.main()
