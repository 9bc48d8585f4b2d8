// Measures how well Glint's picture of a scene agrees with the reference renderer's.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "pipeline/render.h"
#include "pipeline/structure_cache.h"
#include "tests/reference/reference.h"

namespace glint::test {

// Names the oracles. Embree has its own triangle test and takes any of several triangles at equal distance;
// Exact has Glint's rule.
enum class Oracle { Embree, Exact };

struct Agreement {
  double pixels = 0;      // fraction whose channels agree within 1e-3 relative
  double ray_ratio = 0;   // rays of the machine / rays of the reference
  double mean_error = 0;  // largest relative difference of a channel's mean over the picture
};
Agreement compare(const pipeline::RenderResult& picture, const reference::ReferenceResult& expected);

// Keeps structures in a folder of its own, which ends with the object, so that the jobs of a scene build its
// structures once.
class KeptStructures {
 public:
  KeptStructures();
  ~KeptStructures();
  KeptStructures(const KeptStructures&) = delete;
  KeptStructures& operator=(const KeptStructures&) = delete;
  pipeline::StructureCache* cache() { return &cache_; }

 private:
  std::string folder_;
  pipeline::StructureCache cache_;
};

// Describes a scene's shader set with a number of bounces, compared with one of the oracles.
struct Case {
  pipeline::Workload workload;
  uint32_t bounces;
  Oracle oracle;
};

// Loads the scene once and renders all the cases with both renderers: the references first, so that large
// scenes need no more memory than one of the two. Prints a row of a table for each case. The scene may have
// instances.
std::vector<Agreement> agreements(const std::string& scene, const std::string& assets, uint32_t size,
                                  const std::vector<Case>& cases);
std::vector<Agreement> agreements(pipeline::RenderJob job, const std::vector<Case>& cases);

}  // namespace glint::test
