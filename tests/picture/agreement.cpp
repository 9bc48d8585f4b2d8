// Measures how well Glint's picture of a scene agrees with the reference renderer's.
// SPDX-License-Identifier: Apache-2.0
#include "tests/picture/agreement.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <stdlib.h>

#include "tests/reference/surface.h"
#include "tests/support/small_jobs.h"

namespace glint::test {
namespace {

constexpr uint32_t kSamples = 2;

bool close(float a, float b) {
  return std::abs(a - b) <= 1e-3f * std::max(std::abs(b), 1e-3f);
}

std::vector<reference::ReferenceResult> references(const pipeline::RenderJob& job,
                                                   const std::vector<Case>& cases) {
  scenes::Scene flat;
  if (!job.scene.instances.empty()) flat = reference::flattened(job.scene);
  const scenes::Scene& scene = job.scene.instances.empty() ? job.scene : flat;
  std::vector<reference::ReferenceResult> results(cases.size());
  for (const Oracle oracle : {Oracle::Embree, Oracle::Exact}) {
    std::unique_ptr<reference::Intersector> intersector;  // one at a time
    for (size_t i = 0; i < cases.size(); ++i) {
      if (cases[i].oracle != oracle) continue;
      if (!intersector)
        intersector = oracle == Oracle::Embree ? reference::make_embree_intersector(scene)
                                               : reference::make_exact_intersector(scene);
      scenes::RenderParams frame = job.frame;
      frame.bounces = cases[i].bounces;
      results[i] = reference::render(scene, cases[i].workload, frame, *intersector);
    }
  }
  return results;
}

std::string new_folder() {
  std::string path = (std::filesystem::temp_directory_path() / "glint_structures_XXXXXX").string();
  if (!mkdtemp(path.data())) throw std::runtime_error("no folder can be made for structures: " + path);
  return path;
}

}  // namespace

KeptStructures::KeptStructures() : folder_(new_folder()), cache_({.folder = folder_, .build = "test"}) {
}
KeptStructures::~KeptStructures() {
  std::filesystem::remove_all(folder_);
}

Agreement compare(const pipeline::RenderResult& picture, const reference::ReferenceResult& expected) {
  Agreement out;
  size_t agree = 0;
  double mean[3] = {}, expected_mean[3] = {};
  for (size_t i = 0; i < expected.sum.size(); ++i) {
    const float* got = &picture.accumulation[4 * i];
    const float want[3] = {expected.sum[i].x, expected.sum[i].y, expected.sum[i].z};
    bool all = true;
    for (int c = 0; c < 3; ++c) {
      all = all && close(got[c], want[c]);
      mean[c] += double(got[c]);
      expected_mean[c] += double(want[c]);
    }
    agree += all;
  }
  for (int c = 0; c < 3; ++c)
    out.mean_error =
        std::max(out.mean_error, std::abs(mean[c] - expected_mean[c]) / std::max(expected_mean[c], 1e-9));
  out.pixels = double(agree) / double(expected.sum.size());
  out.ray_ratio = double(picture.rays.rays) / double(expected.rays);
  return out;
}

std::vector<Agreement> agreements(pipeline::RenderJob job, const std::vector<Case>& cases) {
  const std::vector<reference::ReferenceResult> expected = references(job, cases);
  KeptStructures structures;
  job.structure_cache = structures.cache();
  job.timing = false;  // the timing machine gives the same bytes (tests/cosim)
  std::vector<Agreement> out;
  pipeline::RenderResult picture;
  for (size_t i = 0; i < cases.size(); ++i) {
    const Case& now = cases[i];
    if (i == 0 || cases[i - 1].workload != now.workload || cases[i - 1].bounces != now.bounces) {
      job.workload = now.workload;
      job.frame.bounces = now.bounces;
      job.shader_dir = std::string(GLINT_SOURCE_DIR) + "/shaders/" + shader_folder(now.workload);
      picture = pipeline::render(job);
    }
    out.push_back(compare(picture, expected[i]));
    std::cout << fmt::format(
                     "| {} | {} | {} | {}{} | {} | {} | {} | {:.2f} | {:.4f} |\n", job.scene.name,
                     job.scene.form, job.scene.triangles(), shader_folder(now.workload),
                     now.workload == pipeline::Workload::PathTracing ? fmt::format(" {}", now.bounces) : "",
                     now.oracle == Oracle::Embree ? "Embree" : "exact", picture.rays.rays, expected[i].rays,
                     100 * out.back().pixels, 100 * out.back().mean_error)
              << std::flush;
  }
  return out;
}

std::vector<Agreement> agreements(const std::string& scene, const std::string& assets, uint32_t size,
                                  const std::vector<Case>& cases) {
  return agreements(small_job(scene, pipeline::Workload::PathTracing, size, kSamples, assets), cases);
}

}  // namespace glint::test
