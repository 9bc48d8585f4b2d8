// Tests that rays recorded through a real Vulkan driver find the same here: hit, distance and any-hit calls.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <span>
#include <string>

#include "tests/support/catch.h"
#include "tests/support/rt_scenes.h"

namespace glint::rt::test {
namespace {

std::vector<char> unpack(const std::filesystem::path& path) {
  FILE* pipe = popen(("zstd -dcq --long=27 '" + path.string() + "'").c_str(), "r");
  REQUIRE(pipe);
  std::vector<char> out, block(1 << 16);
  for (size_t n; (n = fread(block.data(), 1, block.size(), pipe)) > 0;)
    out.insert(out.end(), block.begin(), block.begin() + long(n));
  CAPTURE(path);
  REQUIRE(pclose(pipe) == 0);  // needs the program zstd
  return out;
}

struct Record {  // struct Rec of the recording's shaders
  uint32_t kind, instance, custom, primitive, geometry, hit_kind, tag, flags, any_hits, any_hit_hash, inters,
      call;
  float t, u, v, t_min, origin[3], nx, direction[3], ny;
};
static_assert(sizeof(Record) == 96);
struct RecordedRay {
  float origin[3], t_min, direction[3], t_max;
};

// Holds the recording's scene and shaders, written by hand.
struct Recording {
  nlohmann::json json;
  std::vector<RecordedRay> rays;
  std::vector<Record> records;
  Positions vertices;
  std::vector<std::array<float, 4>> spheres;
  std::vector<Bounds> boxes;
  std::vector<uint32_t> sbt_offset;
  mem::AddressSpace memory;
  StructureInfo top;

  explicit Recording(const std::filesystem::path& folder) {
    std::ifstream(folder / "scene.json") >> json;
    const auto ray_bytes = unpack(folder / "rays.bin.zst"), record_bytes = unpack(folder / "records.bin.zst");
    rays.resize(ray_bytes.size() / sizeof(RecordedRay));
    std::memcpy(rays.data(), ray_bytes.data(), rays.size() * sizeof(RecordedRay));
    records.resize(record_bytes.size() / sizeof(Record));
    std::memcpy(records.data(), record_bytes.data(), records.size() * sizeof(Record));
    vertices = json["verts"].get<Positions>();
    spheres = json["spheres"].get<std::vector<std::array<float, 4>>>();
    for (const auto& s : spheres)
      boxes.push_back({{s[0] - s[3], s[1] - s[3], s[2] - s[3]}, {s[0] + s[3], s[1] + s[3], s[2] + s[3]}});
    std::vector<StructureInfo> bottoms;
    for (const auto& level : json["blas"]) {
      BottomLevel input;
      for (const auto& g : level["geoms"]) {
        Geometry geometry;
        if (g["type"] == "tri")
          geometry.positions =
              std::as_bytes(std::span(vertices).subspan(g["firstVert"], 3 * size_t(g["tris"])));
        else
          geometry.aabbs = boxes;
        geometry.opaque = g["opaque"] != 0;
        input.geometries.push_back(geometry);
      }
      bottoms.push_back(build_bottom(memory, "bottom", input));
    }
    std::vector<Instance> instances;
    for (const auto& i : json["instances"]) {
      instances.push_back({i["xform"], i["customIndex"], i["mask"], i["sbtOffset"], i["flags"], i["blas"]});
      sbt_offset.push_back(i["sbtOffset"]);
    }
    top = build_top(memory, "top", instances, bottoms);
  }

  struct Found {
    RayState state;
    uint32_t any_hits = 0, hash = 0;
    // A sphere was met within rounding of its rim, where the driver's compiler may decide otherwise.
    bool tangent = false;
  };
  void any_hit(Found& f, const nlohmann::json& mode) const {
    const Hit& c = f.state.candidate;
    ++f.any_hits;
    f.hash +=
        (c.instance * 73856093u) ^ (c.primitive * 19349663u) ^ (c.geometry * 83492791u) ^ (c.kind << 20);
    const int rule = mode["ahMode"];
    if (rule == 2) return ignore_candidate(f.state);
    if (rule == 3) return terminate_candidate(f.state);
    // These are the recording's hit records with an alpha test.
    const uint32_t record =
        c.sbt_record + c.geometry * uint32_t(mode["sbtStride"]) + uint32_t(mode["sbtOffset"]);
    const bool hole =
        (record == 0 || record == 7) && !f.state.candidate_procedural && ((int(c.u * 4) + int(c.v * 4)) & 1);
    hole ? ignore_candidate(f.state) : accept_candidate(f.state);
  }
  void intersect(Found& f, const nlohmann::json& mode) const {
    RayState& s = f.state;
    const auto& sphere = spheres[s.candidate.primitive];
    const auto& o = s.space.origin;
    const auto& d = s.space.direction;
    float a = 0, b = 0, c = -sphere[3] * sphere[3];
    for (size_t k = 0; k < 3; ++k)
      a += d[k] * d[k], b += (o[k] - sphere[k]) * d[k], c += (o[k] - sphere[k]) * (o[k] - sphere[k]);
    const float discriminant = b * b - a * c;
    f.tangent |= std::fabs(discriminant) < 1e-4f * b * b;
    for (uint32_t kind = 1; discriminant >= 0 && kind < 3; ++kind) {
      const float q = kind == 1 ? -std::sqrt(discriminant) : std::sqrt(discriminant);
      const Report answer = report(s, (-b + q) / a, kind);
      if (answer == Report::NeedsAnyHit) any_hit(f, mode);
      if (s.report_accepted) break;
    }
    finish_intersection(s);
  }
  Found trace(const RecordedRay& ray, const nlohmann::json& mode) const {
    Found f;
    f.state = ray_of(top.address, {ray.origin[0], ray.origin[1], ray.origin[2]},
                     {ray.direction[0], ray.direction[1], ray.direction[2]}, ray.t_min, ray.t_max,
                     mode["rayFlags"]);
    f.state.ray.cull_mask = mode["mask"];
    REQUIRE(begin(f.state, memory));
    while (f.state.status != RayStatus::Done) {
      run(f.state, memory);
      if (f.state.status == RayStatus::NeedsAnyHit) any_hit(f, mode);
      if (f.state.status == RayStatus::NeedsIntersection) intersect(f, mode);
    }
    return f;
  }
};

struct Tally {
  uint32_t hits = 0, misses = 0, tangents = 0, outcome = 0, primitive = 0, values = 0, calls = 0;
};

Tally compare_mode(const Recording& recording, size_t m) {
  const auto& mode = recording.json["modes"][m];
  const size_t count = recording.json["raysPerPattern"];
  const bool closest = (uint32_t(mode["rayFlags"]) & ray_flag::kSkipClosestHit) == 0;
  const bool any = (uint32_t(mode["rayFlags"]) & ray_flag::kTerminateOnFirstHit) != 0 || mode["ahMode"] == 3;
  Tally tally;
  for (size_t i = 0; i < count; ++i) {
    const Record& theirs = recording.records[m * count + i];
    const Recording::Found found = recording.trace(recording.rays[size_t(mode["pattern"]) * count + i], mode);
    const Hit& ours = found.state.committed;
    ++(ours.valid() ? tally.hits : tally.misses);
    const bool hit = theirs.kind < 10;
    if (found.tangent && (hit != ours.valid() || theirs.any_hits != found.any_hits)) {
      ++tally.tangents;
      continue;
    }
    tally.outcome += hit != ours.valid();
    if (mode["ahMode"] == 2)
      tally.calls += theirs.any_hits != found.any_hits || theirs.any_hit_hash != found.hash;
    if (!hit || !ours.valid() || !closest || any) continue;
    const bool same = ours.instance == theirs.instance && ours.primitive == theirs.primitive &&
                      ours.geometry == theirs.geometry;
    // On an edge, either neighbour is right.
    tally.primitive += !same && std::fabs(ours.t - theirs.t) > 1e-5f * theirs.t;
    if (!same) continue;
    const bool values =
        ours.custom_index == theirs.custom && ours.kind == theirs.hit_kind &&
        std::fabs(ours.t - theirs.t) < 1e-4f * std::fmax(1.f, theirs.t) &&
        (theirs.kind != 1 || (std::fabs(ours.u - theirs.u) < 1e-3f && std::fabs(ours.v - theirs.v) < 1e-3f));
    tally.values += !values;
  }
  return tally;
}

TEST_CASE("rays recorded through a Vulkan driver find what the driver found") {
  const std::filesystem::path folder = std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/vulkan-rt";
  if (!std::filesystem::exists(folder / "scene.json")) {
    WARN("SKIPPED: no recording at " << folder << "; nothing was compared");
    return;
  }
  const Recording recording(folder);
  uint32_t hits = 0, misses = 0;
  for (size_t m = 0; m < recording.json["modes"].size(); ++m) {
    const Tally t = compare_mode(recording, m);
    const std::string name = recording.json["modes"][m]["name"];
    CAPTURE(name, t.hits, t.misses, t.outcome, t.primitive, t.values, t.calls);
    CHECK(t.tangents <= 2);
    CHECK(t.outcome == 0);
    CHECK(t.primitive == 0);
    CHECK(t.values == 0);
    CHECK(t.calls == 0);
    hits += t.hits, misses += t.misses;
  }
  CHECK(hits > 5000);
  CHECK(misses > 5000);
}

}  // namespace
}  // namespace glint::rt::test
