// Names the stages of shaders, and holds sets of them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <initializer_list>

namespace glint::isa {

enum class Stage : uint8_t { RayGeneration, Intersection, AnyHit, ClosestHit, Miss, Callable, Compute };
inline constexpr int kNumStages = int(Stage::Compute) + 1;

class StageSet {
 public:
  constexpr StageSet(std::initializer_list<Stage> stages) {
    for (const Stage s : stages) bits_ = uint8_t(bits_ | 1u << int(s));
  }
  constexpr bool contains(Stage s) const { return bits_ >> int(s) & 1; }

 private:
  uint8_t bits_ = 0;
};
inline constexpr StageSet kAllStages{Stage::RayGeneration, Stage::Intersection, Stage::AnyHit,
                                     Stage::ClosestHit,    Stage::Miss,         Stage::Callable,
                                     Stage::Compute};

}  // namespace glint::isa
