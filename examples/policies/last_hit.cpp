// Implements the ray entry `last_hit`: an occlusion ray begins where the last one of its octant has hit.
// SPDX-License-Identifier: Apache-2.0
#include <array>
#include <cstddef>

#include "rtunit/ray_entry.h"

namespace glint::rt {
namespace {

// Keeps one node for each octant of directions, the one `go_up` levels above the leaf of the last hit.
class LastHit final : public RayEntry {
 public:
  static constexpr std::string_view kName = "last_hit";
  static constexpr std::string_view kDoc =
      "An occlusion ray begins where the last one of its octant has hit.";
  struct Params {
    uint32_t go_up = 3;
    static ParamList params() {
      return {param(&Params::go_up, "go_up", "level",
                    "Number of levels from the leaf with the hit up to the node that is remembered.", 0, 32)};
    }
  };
  LastHit(Params params, Context) : go_up_(params.go_up) {}

  Timing timing() const override { return {.latency = 1, .interval = 1, .units = 4}; }
  bool wants_path() const override { return true; }  // start_above() walks it.
  bool wants(const Ray& ray) const override { return ray.flags & ray_flag::kTerminateOnFirstHit; }

  std::optional<Start> look_up(const RayState& ray) override {
    const Entry& entry = entries_[octant_of(ray.ray)];
    return entry.structure == ray.ray.structure ? entry.start : std::nullopt;
  }
  std::optional<Start> learn(const RayState& ray, const Hit& hit) override {
    return start_above(ray, hit, go_up_);
  }
  void ended(const RayState& ray, const Ending& ending) override {
    if (ending.learned) entries_[octant_of(ray.ray)] = {ray.ray.structure, ending.learned};
  }

 private:
  struct Entry {
    Address structure = 0;
    std::optional<Start> start;
  };
  static size_t octant_of(const Ray& ray) {
    return size_t{ray.direction[0] < 0} | size_t{ray.direction[1] < 0} << 1 |
           size_t{ray.direction[2] < 0} << 2;
  }

  const uint32_t go_up_;
  std::array<Entry, 8> entries_{};
};

const Register<RayEntry, LastHit> registered;

}  // namespace
}  // namespace glint::rt
