// Implements the any-hit mode `deferred`: the traversal runs on and gathers candidates in a table. Then
// shaders run over the table, one shader at a time.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <bit>
#include <tuple>

#include "base/num_lanes.h"
#include "base/registry.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/traversal/traversal.h"

namespace glint::rt {
namespace {

// Holds the lanes of a warp that have candidates for one shader, and the nearest candidate of each.
struct Group {
  uint32_t shader = AnyHitMode::kNoShader;
  LaneMask lanes = 0;
  std::array<uint8_t, kLanes> row{};
};

// The nearest candidate comes first, because committing it drops the most others. Among candidates at the
// same distance, the one that wins as a hit comes first (traversal/hit_rules.h).
bool comes_before(const Hit& a, const Hit& b) {
  return std::tie(a.t, a.instance, a.geometry, a.primitive) <
         std::tie(b.t, b.instance, b.geometry, b.primitive);
}

// A round considers this many shaders. Candidates of further shaders wait for a later round.
constexpr size_t kMaxGroups = 64;
struct Groups {
  std::array<Group, kMaxGroups> group;
  size_t count = 0;

  void add(const RayState& ray, int lane, uint32_t row, uint32_t shader) {
    size_t at = 0;
    while (at < count && group[at].shader != shader) ++at;
    if (at == kMaxGroups) return;
    if (at == count) group[count++] = {shader, 0, {}};
    Group& g = group[at];
    uint8_t& best = g.row[size_t(lane)];
    const bool is_first = !(g.lanes >> lane & 1);
    if (is_first || comes_before(ray.table->row[row].hit, ray.table->row[best].hit)) best = uint8_t(row);
    g.lanes |= LaneMask{1} << lane;
  }
};

// Prefers the shader that the most lanes can run together. Vulkan-Sim's function-call coalescing makes as
// many calls: it calls each shader as often as the lane with the most candidates for it needs.
bool is_better(const Group& a, const Group& b) {
  if ((a.shader == AnyHitMode::kNoShader) != (b.shader == AnyHitMode::kNoShader))
    return b.shader == AnyHitMode::kNoShader;
  if (num_lanes(a.lanes) != num_lanes(b.lanes)) return num_lanes(a.lanes) > num_lanes(b.lanes);
  return a.shader < b.shader;
}

class Deferred final : public AnyHitMode {
 public:
  static constexpr std::string_view kName = "deferred";
  static constexpr std::string_view kDoc =
      "Rays gather candidates in tables; shaders run over them after the traversal.";
  struct Params {
    uint32_t table_entries = 8;  // Choice: Vulkan-Sim has 1,000 and stops the run when a table is full.
    static ParamList params() {
      return {param(
          &Params::table_entries, "table_entries", "candidate",
          "Number of candidates that a ray's table holds. When it is full, their shaders run before the "
          "traversal goes on.",
          1, kMaxTableRows)};
    }
  };
  Deferred(Params params, Context) : params_(params) {}

  uint32_t table_rows() const override { return params_.table_entries; }

  // Model: the mode knows the shader and the distance of each entry without reading the table.
  void present(RayState* rays, LaneMask lanes, const ShaderOf& shader_of) const override {
    Groups groups;
    for_each_lane(lanes, [&](int lane) {
      const CandidateTable& table = *rays[lane].table;
      for (uint32_t rest = table.used; rest; rest &= rest - 1) {
        const auto row = uint32_t(std::countr_zero(rest));
        groups.add(rays[lane], lane, row, shader_of(lane, table.row[row]));
      }
    });
    const Group* best = &groups.group[0];
    for (size_t i = 1; i < groups.count; ++i)
      if (is_better(groups.group[i], *best)) best = &groups.group[i];
    for_each_lane(best->lanes, [&](int lane) { rt::present(rays[lane], best->row[size_t(lane)]); });
    // Candidates without a shader are decided beside the chosen shader at no cost.
    for (size_t i = 0; i < groups.count; ++i) {
      const Group& group = groups.group[i];
      if (group.shader != kNoShader || &group == best) continue;
      for_each_lane(group.lanes & ~best->lanes,
                    [&](int lane) { rt::present(rays[lane], group.row[size_t(lane)]); });
    }
  }

 private:
  const Params params_;
};

const Register<AnyHitMode, Deferred> registered;

}  // namespace
}  // namespace glint::rt
