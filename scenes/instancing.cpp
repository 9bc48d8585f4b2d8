// Finds affine copies: candidates by a hash of what must be equal, then the matrix by least squares.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/instancing.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_access.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <unordered_map>
#include <utility>
#include <vector>

#include "scenes/mesh.h"

namespace glint::scenes {
namespace {

using glm::dmat3;
using glm::dvec3;

constexpr double kTolerance = 1e-5;  // share of the copy's largest extent: files have 5 to 7 digits
constexpr double kFloatSteps = 8;    // float steps at the largest coordinate, for copies far from the origin
// An entry of a matrix below this share of the largest one is taken for zero: positions of float do not
// resolve it, and it would tilt the normals of upright walls, whose sign decides whether a ray towards the
// zenith starts.
constexpr double kEntryNoise = 0x1p-21;
constexpr double kNormalCosine = 0.995;  // Files round normals to three or four digits.
// A body is flat when the determinant of its matrix, scaled to trace 1, is below this value.
constexpr double kFlat = 1e-9;

dvec3 centre_of(const Model& model) {
  dvec3 sum(0);
  for (const Vertex& v : model.vertices) sum += dvec3(v.position);
  return sum / double(model.vertices.size());
}

dvec3 offset(const Vertex& v, const dvec3& centre) {
  return dvec3(v.position) - centre;
}

double trace(const dmat3& m) {
  return m[0][0] + m[1][1] + m[2][2];
}
// Expands by the first row. glm::determinant() expands by the first column, which rounds otherwise.
double determinant(const dmat3& m) {
  return dot(row(m, 0), cross(row(m, 1), row(m, 2)));
}
// Divides by the determinant. glm::inverse() multiplies by its reciprocal, which rounds twice.
dmat3 inverse_of(const dmat3& m) {
  const dvec3 rows[3] = {row(m, 0), row(m, 1), row(m, 2)};
  const dvec3 first = cross(rows[1], rows[2]);
  const double det = dot(rows[0], first);
  return {first / det, cross(rows[2], rows[0]) / det, cross(rows[0], rows[1]) / det};
}

// Returns the unit normal of a triangle, on the side of its first vertex's normal, because a mirrored copy
// winds the other way.
dvec3 plane_normal(const Model& model, size_t triangle) {
  const auto vertex = [&](size_t i) { return model.vertices[model.indices[3 * triangle + i]]; };
  const dvec3 a(vertex(0).position), b(vertex(1).position), c(vertex(2).position);
  const dvec3 n = cross(b - a, c - a);
  const double side = dot(n, dvec3(vertex(0).normal)) < 0 ? -1 : 1;
  const double length = side * std::sqrt(dot(n, n));
  return length != 0 ? n / length : dvec3(0);
}

size_t largest_triangle(const Model& model) {
  size_t best = 0;
  double area = -1;
  for (size_t t = 0; t < model.indices.size() / 3; ++t) {
    const auto corner = [&](size_t i) { return model.vertices[model.indices[3 * t + i]].position; };
    const Vec3 n = cross(corner(1) - corner(0), corner(2) - corner(0));
    if (const auto size = double(dot(n, n)); size > area) area = size, best = t;
  }
  return best;
}

// Returns the linear part that fits best: D * C^-1 with C = sum p p^T and D = sum q p^T about the centres. A
// flat body leaves one direction open, so its normal is mapped to the copy's normal.
std::optional<dmat3> linear_part(const Model& from, const Model& to, const dvec3& from_centre,
                                 const dvec3& to_centre) {
  dmat3 c(0), d(0);
  for (size_t i = 0; i < from.vertices.size(); ++i) {
    const dvec3 p = offset(from.vertices[i], from_centre), q = offset(to.vertices[i], to_centre);
    c += outerProduct(p, p);
    d += outerProduct(q, p);
  }
  const double scale = trace(c);
  if (!(scale > 0)) return {};
  if (determinant(c) < kFlat * scale * scale * scale) {
    const size_t triangle = largest_triangle(from);
    const dvec3 n = plane_normal(from, triangle);
    c += outerProduct(scale * n, n);
    d += outerProduct(scale * plane_normal(to, triangle), n);
  }
  if (determinant(c) < kFlat * scale * scale * scale) return {};
  return d * inverse_of(c);
}

// Sets entries that are only noise of the fit to zero.
void drop_noise(dmat3& m) {
  double largest = 0;
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r) largest = std::max(largest, std::fabs(m[c][r]));
  for (int c = 0; c < 3; ++c)
    for (int r = 0; r < 3; ++r)
      if (std::fabs(m[c][r]) < kEntryNoise * largest) m[c][r] = 0;
}

bool moves_onto(const Model& from, const Model& to, const Affine& m) {
  const Bounds box = bounds(to);
  float extent = 0, largest = 0;
  for (size_t i = 0; i < 3; ++i) {
    extent = std::max(extent, box.upper[i] - box.lower[i]);
    largest = std::max({largest, std::fabs(box.upper[i]), std::fabs(box.lower[i])});
  }
  const double tolerance = kTolerance * double(extent) + kFloatSteps * 0x1p-24 * double(largest);
  for (size_t i = 0; i < from.vertices.size(); ++i)
    for (size_t r = 0; r < 3; ++r) {
      double x = m[r][3];
      for (size_t k = 0; k < 3; ++k) x += double(m[r][k]) * double(from.vertices[i].position[k]);
      if (!(std::fabs(x - double(to.vertices[i].position[r])) <= tolerance)) return false;
    }
  return true;
}

bool normals_follow(const Model& from, const Model& to, const dmat3& m) {
  const dmat3 back = transpose(inverse_of(m));
  for (size_t i = 0; i < from.vertices.size(); ++i) {
    const dvec3 turned = back * dvec3(from.vertices[i].normal), wanted(to.vertices[i].normal);
    const double lengths = std::sqrt(dot(turned, turned) * dot(wanted, wanted));
    if (lengths > 0 && dot(turned, wanted) < kNormalCosine * lengths) return false;
  }
  return true;
}

// Returns for each texture the index of the first one with the same texels. Files name the same picture more
// than once.
std::vector<int32_t> first_alike(const std::vector<Texture>& textures) {
  const auto alike = [&](const Texture& a, const Texture& b) {
    return a.width == b.width && a.height == b.height && a.srgb == b.srgb && a.repeat == b.repeat &&
           a.rgba == b.rgba;
  };
  std::vector<int32_t> first(textures.size());
  for (size_t i = 0; i < textures.size(); ++i)
    first[i] = int32_t(std::find_if(textures.begin(), textures.begin() + ptrdiff_t(i),
                                    [&](const Texture& t) { return alike(t, textures[i]); }) -
                       textures.begin());
  return first;
}

// Returns for each material the index of the first one that is equal to it.
std::vector<size_t> first_equal(const Scene& scene) {
  const std::vector<int32_t> textures = first_alike(scene.textures);
  const auto texture_of = [&](const Material& m) {
    return m.texture < 0 ? m.texture : textures[size_t(m.texture)];
  };
  const auto equal = [&](const Material& a, const Material& b) {
    return a.diffuse == b.diffuse && texture_of(a) == texture_of(b) && a.fuzziness == b.fuzziness &&
           a.refraction_index == b.refraction_index && a.model == b.model;
  };
  std::vector<size_t> first(scene.materials.size());
  for (size_t i = 0; i < first.size(); ++i) {
    const auto end = scene.materials.begin() + ptrdiff_t(i);
    first[i] =
        size_t(std::find_if(scene.materials.begin(), end, [&](const Material& m) { return equal(m, *end); }) -
               scene.materials.begin());
  }
  return first;
}

// Compares two models that may be copies: all but positions and normals must be equal bit for bit.
bool same_but_moved(const std::vector<size_t>& materials, const Model& a, const Model& b) {
  return a.vertices.size() == b.vertices.size() && a.indices == b.indices &&
         std::equal(a.vertices.begin(), a.vertices.end(), b.vertices.begin(),
                    [&](const Vertex& v, const Vertex& w) {
                      return v.texture_coordinate == w.texture_coordinate &&
                             materials[size_t(v.material)] == materials[size_t(w.material)];
                    });
}

uint64_t shape_hash(const Model& model) {
  uint64_t hash = model.vertices.size();
  const auto add = [&hash](uint64_t word) { hash = std::rotl((hash ^ word) * 0x9e3779b97f4a7c15, 29); };
  for (const uint32_t index : model.indices) add(index);
  for (const Vertex& v : model.vertices) add(std::bit_cast<uint64_t>(v.texture_coordinate));
  return hash;
}

}  // namespace

std::optional<Affine> affine_between(const Model& from, const Model& to) {
  if (from.vertices.empty() || from.vertices.size() != to.vertices.size() || from.indices.empty()) return {};
  const dvec3 p = centre_of(from), q = centre_of(to);
  std::optional<dmat3> linear = linear_part(from, to, p, q);
  if (!linear || determinant(*linear) == 0 || !std::isfinite(determinant(*linear))) return {};
  drop_noise(*linear);
  Affine out;
  for (size_t r = 0; r < 3; ++r) {
    const dvec3 linear_row = row(*linear, r);
    out[r] = {float(linear_row[0]), float(linear_row[1]), float(linear_row[2]),
              float(q[r] - dot(linear_row, p))};
  }
  if (!moves_onto(from, to, out) || !normals_follow(from, to, *linear)) return {};
  return out;
}

void share_copies(Scene& scene) {
  if (!scene.instances.empty()) return;
  const std::vector<size_t> materials = first_equal(scene);
  std::vector<Model> kept;
  std::vector<Instance> instances;
  std::unordered_map<uint64_t, std::vector<uint32_t>> alike;  // indices into `kept`
  for (Model& model : scene.models) {
    std::vector<uint32_t>* bucket = model.is_procedural() ? nullptr : &alike[shape_hash(model)];
    std::optional<Affine> matrix;
    uint32_t original = 0;
    for (size_t i = 0; bucket && i < bucket->size() && !matrix; ++i) {
      original = (*bucket)[i];
      if (same_but_moved(materials, kept[original], model)) matrix = affine_between(kept[original], model);
    }
    if (matrix) {
      instances.push_back({original, *matrix});
      continue;
    }
    instances.push_back({uint32_t(kept.size()), kIdentity});
    if (bucket) bucket->push_back(uint32_t(kept.size()));
    kept.push_back(std::move(model));
  }
  const size_t before = scene.models.size();
  scene.models = std::move(kept);
  if (scene.models.size() == before) return;
  scene.instances = std::move(instances);
  scene.note +=
      fmt::format(" {} of {} models are instances of others.", before - scene.models.size(), before);
}

}  // namespace glint::scenes
