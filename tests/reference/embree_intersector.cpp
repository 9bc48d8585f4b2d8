// Implements both intersectors on one Embree tree.
// SPDX-License-Identifier: Apache-2.0
//
// Geometry i of the tree is model i. Spheres are user geometry whose candidates tests/reference/shapes.cpp
// decides; the exact intersector treats triangles in the same way.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <memory>

#include "base/check.h"
#include "tests/reference/surface.h"
#include "tests/support/embree.h"

namespace glint::reference {
namespace {

struct Query {
  test::EmbreeContext context;  // first: Embree hands this part to the callbacks
  Ray ray;
  Hit best;
  const scenes::Scene* scene;
  bool passes(const Hit& hit) const { return !ray.opaque && is_hole(*scene, hit); }
};

class EmbreeIntersector final : public Intersector {
 public:
  EmbreeIntersector(const scenes::Scene& scene, bool exact) : scene_(scene), device_(rtcNewDevice(nullptr)) {
    GLINT_CHECK(device_ != nullptr, "Embree cannot start: error {}", int(rtcGetDeviceError(nullptr)));
    tree_ = rtcNewScene(device_);
    rtcSetSceneFlags(tree_, RTC_SCENE_FLAG_ROBUST);
    for (uint32_t i = 0; i < scene.models.size(); ++i) {
      const scenes::Model& model = scene.models[i];
      RTCGeometry geometry = model.is_procedural() || exact ? user_geometry(model) : triangles(model);
      rtcCommitGeometry(geometry);
      rtcAttachGeometryByID(tree_, geometry, i);
      rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(tree_);
  }
  ~EmbreeIntersector() override {
    rtcReleaseScene(tree_);
    rtcReleaseDevice(device_);
  }
  EmbreeIntersector(const EmbreeIntersector&) = delete;
  EmbreeIntersector& operator=(const EmbreeIntersector&) = delete;

  Hit closest(const Ray& ray) override {
    Query query;
    test::start(query.context);
    query.ray = ray;
    query.scene = &scene_;
    RTCRayHit rh{};
    rh.ray.org_x = ray.origin.x, rh.ray.org_y = ray.origin.y, rh.ray.org_z = ray.origin.z;
    rh.ray.dir_x = ray.direction.x, rh.ray.dir_y = ray.direction.y, rh.ray.dir_z = ray.direction.z;
    rh.ray.tnear = ray.t_min;
    rh.ray.tfar = ray.t_max;
    rh.ray.mask = ~0u;
    rh.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    test::intersect(tree_, query.context, rh);
    if (rh.hit.geomID == RTC_INVALID_GEOMETRY_ID) return {};
    // A user-geometry hit keeps its numbers in the query.
    if (!query.best.missed() && query.best.model == rh.hit.geomID) return query.best;
    return {rh.hit.geomID, rh.hit.primID, rh.ray.tfar, rh.hit.u, rh.hit.v};
  }

 private:
  RTCGeometry triangles(const scenes::Model& model) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* positions = static_cast<float*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, model.vertices.size()));
    for (size_t i = 0; i < model.vertices.size(); ++i)
      std::memcpy(positions + 3 * i, &model.vertices[i].position[0], 12);
    void* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12,
                                            model.indices.size() / 3);
    std::memcpy(indices, model.indices.data(), model.indices.size() * 4);
    if (scene_.alpha_test) rtcSetGeometryIntersectFilterFunction(geometry, leave_holes);
    return geometry;
  }

  RTCGeometry user_geometry(const scenes::Model& model) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_USER);
    rtcSetGeometryUserPrimitiveCount(geometry,
                                     model.is_procedural() ? 1 : unsigned(model.indices.size() / 3));
    rtcSetGeometryUserData(geometry, const_cast<scenes::Model*>(&model));
    rtcSetGeometryBoundsFunction(geometry, bound, nullptr);
    rtcSetGeometryIntersectFunction(geometry, visit);
    return geometry;
  }

  static void leave_holes(const RTCFilterFunctionNArguments* args) {
    const auto& query = *reinterpret_cast<const Query*>(args->context);
    const auto& hit = *reinterpret_cast<const RTCHit*>(args->hit);
    if (query.passes({hit.geomID, hit.primID, 0, hit.u, hit.v})) args->valid[0] = 0;
  }

  static void bound(const RTCBoundsFunctionArguments* args) {
    const auto& model = *static_cast<const scenes::Model*>(args->geometryUserPtr);
    float low[3], high[3];
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = model.center[axis] - model.radius;
      high[axis] = model.center[axis] + model.radius;
      if (!model.is_procedural()) {
        float corner[3];
        for (size_t k = 0; k < 3; ++k)
          corner[k] = model.vertices[model.indices[3 * args->primID + k]].position[axis];
        low[axis] = std::min({corner[0], corner[1], corner[2]});
        high[axis] = std::max({corner[0], corner[1], corner[2]});
      }
      // This is room for the rounding of our own tests, so that the tree never loses what they accept.
      const float pad = 1e-5f * std::max({1.0f, std::abs(low[axis]), std::abs(high[axis])});
      low[axis] -= pad;
      high[axis] += pad;
    }
    *args->bounds_o = {low[0], low[1], low[2], 0, high[0], high[1], high[2], 0};
  }

  static void visit(const RTCIntersectFunctionNArguments* args) {
    if (!args->valid[0]) return;
    const auto& model = *static_cast<const scenes::Model*>(args->geometryUserPtr);
    auto& query = *reinterpret_cast<Query*>(args->context);
    auto& rh = *reinterpret_cast<RTCRayHit*>(args->rayhit);
    Hit hit;
    hit.model = args->geomID;
    hit.primitive = args->primID;
    if (model.is_procedural()) {
      hit.t = meets_sphere(query.ray, model.center, model.radius);
      if (hit.t < 0) return;
    } else {
      const auto corner = [&](size_t k) -> Vec {
        return model.vertices[model.indices[3 * args->primID + k]].position;
      };
      if (!meets_triangle(query.ray, corner(0), corner(1), corner(2), hit)) return;
      if (!(query.ray.t_min < hit.t && hit.t < query.ray.t_max)) return;
      if (query.passes(hit)) return;
    }
    const bool found = rh.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    const bool first_of_equals =
        found && (hit.model < rh.hit.geomID || (hit.model == rh.hit.geomID && hit.primitive < rh.hit.primID));
    if (hit.t > rh.ray.tfar || (hit.t == rh.ray.tfar && found && !first_of_equals)) return;
    rh.ray.tfar = hit.t;
    rh.hit.geomID = hit.model;
    rh.hit.primID = hit.primitive;
    query.best = hit;
  }

  const scenes::Scene& scene_;
  RTCDevice device_;
  RTCScene tree_ = nullptr;
};

}  // namespace

std::unique_ptr<Intersector> make_embree_intersector(const scenes::Scene& scene) {
  return std::make_unique<EmbreeIntersector>(scene, false);
}

std::unique_ptr<Intersector> make_exact_intersector(const scenes::Scene& scene) {
  return std::make_unique<EmbreeIntersector>(scene, true);
}

}  // namespace glint::reference
