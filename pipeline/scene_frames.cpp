// Prepares the frames of a scene that moves, and updates its acceleration structures.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <utility>

#include "base/check.h"
#include "base/host_threads.h"
#include "pipeline/scene_world.h"
#include "rtunit/structure/cost.h"
#include "rtunit/structure/refit.h"
#include "scenes/motion.h"

namespace glint::pipeline {

// Holds what is kept between frames to update the structures.
struct SceneWorld::Moving {
  explicit Moving(const RenderJob& job)
      : deformed(job.scene.motion->deformed()),
        fits_bottoms(job.update != StructureUpdate::Rebuild),
        fits_top(job.update == StructureUpdate::Refit) {
    if (fits_bottoms)
      for (const uint32_t model : deformed) bottom_trees.try_emplace(model);
  }

  const std::vector<uint32_t> deformed;
  const bool fits_bottoms, fits_top;
  std::map<size_t, rt::KeptTree> bottom_trees;  // of deformed models, where they are fitted
  rt::KeptTree top_tree;                        // where it is fitted
  std::vector<rt::Instance> instances;          // of the last frame
  std::vector<double> visits;                   // what a ray visits in each bottom level (measure())
};

SceneWorld::~SceneWorld() = default;

bool SceneWorld::deforms(size_t model) const {
  return moving_ && std::binary_search(moving_->deformed.begin(), moving_->deformed.end(), uint32_t(model));
}

rt::KeptTree* SceneWorld::kept_tree(size_t model) {
  if (!moving_) return nullptr;
  const auto found = moving_->bottom_trees.find(model);
  return found == moving_->bottom_trees.end() ? nullptr : &found->second;
}

rt::EncodedStructure SceneWorld::encode_top(const RenderJob& job, std::span<const rt::Instance> instances) {
  if (!moving_) return rt::encode_top(kTopName, instances, bottoms_, job.gpu.bvh);
  // What is scaled down to nothing is hidden for a while.
  std::vector<std::string> hidden;
  moving_->instances.assign(instances.begin(), instances.end());
  return rt::encode_top(kTopName, instances, bottoms_, job.gpu.bvh, &hidden,
                        moving_->fits_top ? &moving_->top_tree : nullptr);
}

StructureWork SceneWorld::first_work(const RenderJob& job) {
  StructureWork work;
  work.bottom.built = bottoms_.size(), work.top.built = 1;
  measure(job, work);
  return work;
}

StructureWork SceneWorld::advance(const RenderJob& job) {
  GLINT_CHECK(moving_, "the scene {} does not move", job.scene.name);
  StructureWork work;
  for (const uint32_t handle : {kAccumulation, kPicture})
    std::ranges::fill(memory_.view<std::byte>(world.images[handle].base, world.images[handle].bytes()),
                      std::byte{0});
  const std::vector<std::byte> frame = scenes::uniform_block(job.scene, job.workload, job.frame);
  memory_.write(frame_, frame.data(), frame.size());
  move_vertices(job);
  for (const uint32_t model : moving_->deformed) update_bottom(job, model, work);
  work.bottom.kept = bottoms_.size() - moving_->deformed.size();
  update_top(job, work);
  measure(job, work);
  return work;
}

void SceneWorld::move_vertices(const RenderJob& job) {
  for (const uint32_t i : moving_->deformed) {
    const scenes::Model& model = job.scene.models[i];
    GLINT_CHECK_EQ(model.vertices.size(), uploaded_[i].vertices.size());
    std::ranges::copy(model.vertices, uploaded_[i].vertices.begin());
    spheres_[i] = sphere_of(model);
  }
}

void SceneWorld::update_bottom(const RenderJob& job, size_t model, StructureWork& work) {
  rt::StructureInfo& info = bottoms_[model];
  const uint32_t threads = host_threads(job.threads);
  if (rt::KeptTree* const kept = kept_tree(model)) {
    BottomInput input;
    describe_bottom(job, model, input);
    const std::string why =
        rt::refit_bottom(*kept, input.level, memory_.view<std::byte>(info.address, info.bytes), threads);
    if (why.empty()) {
      info.bounds = kept->info.bounds;
      ++work.bottom.refitted;
      return;
    }
    work.notes.push_back(
        fmt::format("'{}' was built anew, because {}", name_of_model(job.scene.models[model]), why));
  }
  replace(info, name_of_model(job.scene.models[model]), encode_bottom(job, model, threads, kept_tree(model)));
  ++work.bottom.built;
}

// Returns the bytes that a model's structure may take when it is built anew, or 0 when it never is.
uint64_t SceneWorld::room_of_bottom(const RenderJob& job, size_t model) const {
  if (!deforms(model)) return 0;
  const uint64_t primitives =
      job.scene.models[model].is_procedural() ? 1 : uploaded_[model].indices.size() / 3;
  return rt::most_bytes(0, primitives, job.gpu.bvh);
}

// Places a structure with room behind it, as programs do that build in place.
rt::StructureInfo SceneWorld::place(const std::string& name, rt::EncodedStructure structure, uint64_t room) {
  if (room > structure.bytes.size()) {
    mem::HostBlock block(room);
    std::memcpy(block.data(), structure.bytes.data(), structure.bytes.size());
    structure.bytes = std::move(block);
  }
  return rt::place(memory_, name, std::move(structure));
}

// Writes a structure over another one, or elsewhere where it does not fit, which micromaps may cause.
void SceneWorld::replace(rt::StructureInfo& info, const std::string& name, rt::EncodedStructure structure) {
  structures.bytes += structure.info.bytes - info.bytes;
  if (std::byte* const at = memory_.find(info.address, structure.bytes.size())) {
    std::memcpy(at, structure.bytes.data(), structure.bytes.size());
    structure.info.address = info.address;
    info = structure.info;
    return;
  }
  memory_.free(info.address);
  info = rt::place(memory_, name, std::move(structure));
}

void SceneWorld::update_top(const RenderJob& job, StructureWork& work) {
  const std::vector<rt::Instance> instances = place_instances(job);
  const auto is_there = [](const rt::Instance& a, const rt::Instance& b) {
    return a.transform == b.transform;
  };
  const bool moves = work.bottom.built + work.bottom.refitted > 0 ||
                     !std::ranges::equal(instances, moving_->instances, is_there);
  if (!moves) {
    ++work.top.kept;
    return;
  }
  if (moving_->fits_top) {
    const std::string why = rt::refit_top(moving_->top_tree, instances, bottoms_,
                                          memory_.view<std::byte>(top_.address, top_.bytes));
    if (why.empty()) {
      moving_->instances = instances;
      ++work.top.refitted;
      return;
    }
    work.notes.push_back(fmt::format("the top level was built anew, because {}", why));
  }
  replace(top_, kTopName, encode_top(job, instances));
  structures.top_depth = top_.depth;
  ++work.top.built;
  bind_top();
}

// Finds what rays are expected to visit. What no frame changes is measured once.
void SceneWorld::measure(const RenderJob& job, StructureWork& work) {
  const auto bytes_of = [&](const rt::StructureInfo& info) {
    return memory_.view<const std::byte>(info.address, info.bytes);
  };
  const bool is_first = moving_->visits.empty();
  moving_->visits.resize(bottoms_.size());
  std::map<Address, size_t> models;
  for (size_t i = 0; i < bottoms_.size(); ++i) {
    models[bottoms_[i].address] = i;
    if (is_first || deforms(i)) moving_->visits[i] = rt::expected_visits(bytes_of(bottoms_[i]));
  }
  work.expected_visits =
      rt::expected_visits(bytes_of(top_), [&](Address bottom) { return moving_->visits[models.at(bottom)]; });
  work.expected_visits_rebuilt = work.expected_visits;
  if (work.bottom.refitted + work.top.refitted == 0) return;
  std::vector<double> rebuilt = moving_->visits;
  const auto bytes_in = [](const rt::EncodedStructure& structure) {
    return std::span<const std::byte>(structure.bytes.data(), structure.bytes.size());
  };
  for (const uint32_t i : moving_->deformed)
    if (kept_tree(i))
      rebuilt[i] = rt::expected_visits(bytes_in(encode_bottom(job, i, host_threads(job.threads), nullptr)));
  std::vector<std::string> hidden;
  const rt::EncodedStructure top =
      rt::encode_top(kTopName, moving_->instances, bottoms_, job.gpu.bvh, &hidden);
  work.expected_visits_rebuilt =
      rt::expected_visits(bytes_in(top), [&](Address bottom) { return rebuilt[models.at(bottom)]; });
}

}  // namespace glint::pipeline
