// Implements the entry `predictor`: rays that resemble an earlier ray begin near the leaf that it hit
// (Liu et al.: "Intersection prediction for accelerated GPU ray tracing", MICRO 2021).
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <vector>

#include "base/registry.h"
#include "rtunit/ray_entry.h"

namespace glint::rt {
namespace {

constexpr uint32_t kPolarBits = 8, kAzimuthBits = 9;  // of whole degrees: up to 180, and below 360

// Holds nodes in a table of sets with the least recently used entry leaving first. A ray's hash chooses the
// set, and the whole hash is the tag.
// Model: an update takes no time. An entry is valid for rays of the structure that it was learned in. The
// published tree has one level; here an entry names an instance's leaf and a node below it.
class Predictor final : public RayEntry {
 public:
  static constexpr std::string_view kName = "predictor";
  static constexpr std::string_view kDoc =
      "A ray begins above the leaf that an earlier ray with its hash hit (MICRO 2021).";
  struct Params {
    uint32_t sets = 256, ways = 4;  // 1024 entries, as published
    uint32_t latency = 3;           // Choice: the published 2 cycles of the table and 1 of the look-up
    uint32_t ports = 4;             // published
    uint32_t origin_bits = 5;       // published: 15 bits in all
    uint32_t direction_bits = 3;    // published: 3 bits of the polar angle and 4 of the azimuth
    uint32_t go_up = 3;             // published
    bool all_rays = false;          // published: only rays that end at any hit
    static ParamList params() {
      return {param(&Params::sets, "sets", "set", "Number of sets of the table.", 1, 65536),
              param(&Params::ways, "ways", "entry", "Number of entries of a set.", 1, 64),
              param(&Params::latency, "latency", "cycle", "Cycles that a look-up takes.", 1, 1000),
              param(&Params::ports, "ports", "ray",
                    "Number of rays that are looked up at once. The next rays wait for their end.", 1, 32),
              param(&Params::origin_bits, "origin_bits", "bit",
                    "Bits of the hash that an axis of the ray's origin takes, over the bounds of the scene.",
                    0, 10),
              param(&Params::direction_bits, "direction_bits", "bit",
                    "Bits of the hash that the polar angle of the ray's direction takes. The azimuth takes "
                    "one more.",
                    0, kPolarBits),
              param(&Params::go_up, "go_up", "level",
                    "Number of levels from the leaf with the hit up to the node that is remembered.", 0,
                    kStackEntries),
              flag(&Params::all_rays, "all_rays",
                   "True: rays that look for the nearest hit are looked up, too. False: only rays that may "
                   "end at any hit are.")};
    }
  };
  Predictor(Params params, Context context)
      : params_(params),
        memory_(context.memory),
        stats_(context.stats),
        entries_(size_t{params.sets} * params.ways) {}

  Timing timing() const override { return {params_.latency, params_.latency, params_.ports}; }
  bool wants_path() const override { return true; }
  bool wants(const Ray& ray) const override {
    return params_.all_rays || (ray.flags & ray_flag::kTerminateOnFirstHit);
  }

  std::optional<Start> look_up(const RayState& ray) override {
    Entry* found = find(hash_of(ray.ray), ray.ray.structure);
    if (!found) return std::nullopt;
    found->used = ++time_;
    return found->start;
  }

  std::optional<Start> learn(const RayState& ray, const Hit& hit) override {
    return start_above(ray, hit, params_.go_up);
  }

  void ended(const RayState& ray, const Ending& ending) override {
    if (!ray.committed.valid() || ending.was_verified || !ending.learned) return;
    const uint32_t hash = hash_of(ray.ray);
    Entry* entry = find(hash, ray.ray.structure);
    if (!entry) {
      entry = std::min_element(set_of(hash), set_of(hash) + params_.ways,
                               [](const Entry& a, const Entry& b) { return a.used < b.used; });
      stats_.replaced += entry->used != 0;
    }
    *entry = {hash, ++time_, ray.ray.structure, *ending.learned};
    ++stats_.inserted;
  }

 private:
  struct Entry {
    uint32_t hash = 0;
    uint64_t used = 0;  // order of its last use; 0: the entry is empty
    Address structure = 0;
    Start start;
  };
  struct Stats {
    explicit Stats(stats::Group* parent) : group(parent, "predictor") {}
    stats::Group group;
    stats::Counter inserted{&group, "inserted", "ray", "Number of rays whose node went into the table."};
    stats::Counter replaced{&group, "replaced", "entry",
                            "Number of entries that made way for one of another hash."};
  };

  // Returns a ray's hash: the cell of its origin, with the cell of its direction put over it.
  // Model: the bounds come from the structure's header, and reading them costs nothing.
  uint32_t hash_of(const Ray& ray) const {
    const std::byte* bytes = memory_.find(ray.structure, sizeof(StructureHeader));
    if (!bytes) return 0;
    const Bounds bounds = load<StructureHeader>(bytes).bounds;
    uint32_t out = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const float at = (ray.origin[axis] - bounds.low[axis]) / (bounds.high[axis] - bounds.low[axis]),
                  cells = float(1u << params_.origin_bits);
      const float cell = at > 0 ? std::min(at * cells, cells - 1) : 0;  // 0 for a flat scene, too
      out |= uint32_t(cell) << axis * params_.origin_bits;
    }
    return out ^ direction_of(ray);
  }

  // Returns the top bits of the direction's angles in whole degrees.
  uint32_t direction_of(const Ray& ray) const {
    const double x = ray.direction[0], y = ray.direction[1], z = ray.direction[2],
                 degree = std::numbers::pi / 180;
    const double polar = std::atan2(std::hypot(x, y), z) / degree;
    double azimuth = std::atan2(y, x) / degree;
    if (azimuth < 0) azimuth += 360;
    const uint32_t bits = params_.direction_bits;
    return std::min(uint32_t(azimuth), 359u) >> (kPolarBits - bits) << bits |
           uint32_t(polar) >> (kPolarBits - bits);
  }

  // Folds the hash to as many bits as the number of the last set has.
  Entry* set_of(uint32_t hash) {
    const auto bits = uint32_t(std::bit_width(params_.sets - 1));
    uint32_t folded = 0;
    for (uint32_t rest = hash; rest && bits; rest >>= bits) folded ^= rest & ((1u << bits) - 1);
    return &entries_[size_t{folded % params_.sets} * params_.ways];
  }
  Entry* find(uint32_t hash, Address structure) {
    Entry* set = set_of(hash);
    Entry* end = set + params_.ways;
    Entry* found = std::find_if(
        set, end, [&](const Entry& e) { return e.used && e.hash == hash && e.structure == structure; });
    return found == end ? nullptr : found;
  }

  const Params params_;
  const mem::AddressSpace& memory_;
  Stats stats_;
  std::vector<Entry> entries_;  // set by set
  uint64_t time_ = 0;
};

const Register<RayEntry, Predictor> registered;

}  // namespace
}  // namespace glint::rt
