// Renders the three workloads in plain C++, with code that shares nothing with the machine.
// SPDX-License-Identifier: Apache-2.0
#include "tests/reference/reference.h"

#include <cmath>

#include "base/check.h"
#include "tests/reference/surface.h"

namespace glint::reference {

using scenes::Material;
using scenes::MaterialModel;
using scenes::Workload;

uint32_t hash_pair(uint32_t v0, uint32_t v1) {
  uint32_t sum = 0;
  for (int round = 0; round < 16; ++round) {
    sum += 0x9e3779b9u;
    v0 += ((v1 << 4) + 0xa341316cu) ^ (v1 + sum) ^ ((v1 >> 5) + 0xc8013ea4u);
    v1 += ((v0 << 4) + 0xad90777du) ^ (v0 + sum) ^ ((v0 >> 5) + 0x7e95761eu);
  }
  return v0;
}

float random_float(uint32_t& state) {
  state = state * 1664525u + 1013904223u;
  return float(state & 0xffffffu) / 16777216.0f;
}

namespace {

constexpr float kPi = 3.1415926535897932f;

struct Payload {
  Vec color{};
  float distance = 0;
  Vec scatter{};
  bool goes_on = false;
  Vec normal{};
  uint32_t random_state = 0;
};

Vec draw_in_unit_sphere(uint32_t& state) {
  Vec p{};
  do {
    p.x = 2.0f * random_float(state) - 1.0f;
    p.y = 2.0f * random_float(state) - 1.0f;
    p.z = 2.0f * random_float(state) - 1.0f;
  } while (dot(p, p) >= 1.0f);
  return p;
}

// Returns xyz of a column-major matrix times (v, w), computed column by column in order.
Vec transform(const scenes::Mat4& m, const Vec& v, float w) {
  const auto row = [&](size_t r) { return m[0][r] * v.x + m[1][r] * v.y + m[2][r] * v.z + m[3][r] * w; };
  return {row(0), row(1), row(2)};
}

// Scatters a ray. `texel` is the texture's colour where the ray hit. Lights have none.
void scatter(Payload& ray, const Material& material, const Vec& texel, const Vec& ray_direction,
             const Vec& normal, float distance) {
  const Vec diffuse(material.diffuse);
  const Vec d = normalize(ray_direction);
  const float projection = dot(d, normal);
  ray.distance = distance;
  ray.color = material.model == MaterialModel::DiffuseLight ? diffuse : diffuse * texel;
  switch (material.model) {
    case MaterialModel::Lambertian:
      ray.scatter = normal + draw_in_unit_sphere(ray.random_state);
      ray.goes_on = projection < 0;
      return;
    case MaterialModel::Metallic: {
      const Vec reflected = reflect(d, normal);
      ray.scatter = reflected + draw_in_unit_sphere(ray.random_state) * material.fuzziness;
      ray.goes_on = dot(reflected, normal) > 0;
      return;
    }
    case MaterialModel::Isotropic:  // the shader has no such branch and falls through to dielectric
    case MaterialModel::Dielectric: {
      const float index = material.refraction_index;
      const bool leaves = projection > 0;
      const Vec refracted = refract(d, leaves ? -normal : normal, leaves ? index : 1.0f / index);
      float probability = 1;
      if (refracted.x != 0 || refracted.y != 0 || refracted.z != 0) {
        const float cosine = leaves ? index * projection : -projection;
        float r0 = (1.0f - index) / (1.0f + index);
        r0 = r0 * r0;
        probability = r0 + (1.0f - r0) * std::exp2(5.0f * std::log2(1.0f - cosine));
      }
      ray.color = texel;
      ray.scatter = random_float(ray.random_state) < probability ? reflect(d, normal) : refracted;
      ray.goes_on = true;
      return;
    }
    case MaterialModel::DiffuseLight:
      ray.scatter = {1, 0, 0};
      ray.goes_on = false;
      return;
  }
}

class Renderer {
 public:
  Renderer(const scenes::Scene& scene, Workload workload, const scenes::RenderParams& params,
           Intersector& intersector)
      : scene_(scene),
        workload_(workload),
        uniforms_(frame_uniforms(scene, workload, params)),
        intersector_(intersector) {}

  ReferenceResult run() {
    ReferenceResult result;
    result.width = uniforms_.width;
    result.height = uniforms_.height;
    for (uint32_t y = 0; y < uniforms_.height; ++y)
      for (uint32_t x = 0; x < uniforms_.width; ++x) {
        rays_ = 0;
        const Vec sum = render_pixel(x, y);
        const Vec mean = sum / Vec(float(uniforms_.total_samples));
        result.sum.push_back(sum);
        result.mean.push_back(mean);
        result.picture.push_back({std::sqrt(mean.x), std::sqrt(mean.y), std::sqrt(mean.z)});
        result.rays_of_pixel.push_back(rays_);
        result.rays += rays_;
      }
    return result;
  }

 private:
  Vec render_pixel(uint32_t x, uint32_t y) {
    uint32_t jitter_state = uniforms_.random_seed;
    ray_ = {};
    ray_.random_state = hash_pair(hash_pair(x, y), uniforms_.total_samples);
    Vec sum(0);
    for (uint32_t s = 0; s < uniforms_.samples; ++s) {
      Ray camera{.t_min = 0.001f, .t_max = 10000.0f};
      make_camera_ray(x, y, jitter_state, camera);
      switch (workload_) {
        case Workload::PathTracing:
          sum = sum + trace_path(camera);
          break;
        case Workload::Shadow:
          sum = sum + trace_shadows(camera);
          break;
        case Workload::AmbientOcclusion:
          sum = sum + trace_occlusion(camera);
          break;
      }
    }
    return sum;
  }

  void make_camera_ray(uint32_t x, uint32_t y, uint32_t& jitter_state, Ray& camera) {
    const float jitter_x = random_float(jitter_state);
    const float jitter_y = random_float(jitter_state);
    const float ndc_x = (float(x) + jitter_x) / float(uniforms_.width) * 2.0f - 1.0f;
    const float ndc_y = (float(y) + jitter_y) / float(uniforms_.height) * 2.0f - 1.0f;
    float px, py;
    do {
      px = 2.0f * random_float(ray_.random_state) - 1.0f;
      py = 2.0f * random_float(ray_.random_state) - 1.0f;
    } while (px * px + py * py >= 1.0f);
    const Vec lens{uniforms_.aperture / 2.0f * px, uniforms_.aperture / 2.0f * py, 0};
    const Vec target = transform(uniforms_.matrices.projection_inverse, {ndc_x, ndc_y, 1}, 1);
    camera.origin = transform(uniforms_.matrices.model_view_inverse, lens, 1);
    camera.direction = transform(uniforms_.matrices.model_view_inverse,
                                 normalize(target * uniforms_.focus_distance - lens), 0);
  }

  Vec trace_path(Ray ray) {
    Vec throughput(1);
    ray.opaque = !scene_.alpha_test;  // shadow and occlusion rays are opaque in every scene
    for (uint32_t b = 0; b < uniforms_.bounces; ++b) {
      trace(ray);
      throughput = throughput * ray_.color;
      if (ray_.distance < 0 || !ray_.goes_on) return throughput;
      ray.origin = ray.origin + ray.direction * ray_.distance;
      ray.direction = ray_.scatter;
    }
    return {};
  }

  Vec trace_shadows(const Ray& camera) {
    trace(camera);
    Vec color = ray_.color;
    if (ray_.distance < 0) return color;
    const Vec normal = ray_.normal;
    Ray shadow{.t_min = 0.001f, .t_max = 10000.0f};
    shadow.origin = camera.origin + camera.direction * ray_.distance + normal * 0.001f;
    for (uint32_t j = 0; j < uniforms_.secondary_rays; ++j) {
      shadow.direction = {0, 1, 0};
      if (!uniforms_.has_sky) {
        const Vec lamp =
            uniforms_.light_position + draw_in_unit_sphere(ray_.random_state) * uniforms_.light_radius;
        const Vec to_light = lamp - shadow.origin;
        shadow.t_max = length(to_light);
        shadow.direction = normalize(to_light);
      }
      bool blocked = true;
      if (dot(shadow.direction, normal) > 0) {
        trace(shadow);
        blocked = ray_.distance > 0;
      }
      if (blocked) color = color * 0.3f;
    }
    return color;
  }

  Vec trace_occlusion(const Ray& camera) {
    trace(camera);
    Vec color = ray_.color;
    if (ray_.distance < 0) return color;
    const Vec point = ray_.scatter;
    for (uint32_t j = 0; j < uniforms_.secondary_rays; ++j) {
      Ray ray{.t_min = 0.001f, .t_max = 10.0f};
      ray.direction = normalize(draw_in_unit_sphere(ray_.random_state));
      if (dot(ray.direction, ray_.normal) <= 0) ray.direction = -ray.direction;
      ray.origin = point + ray.direction * 0.01f;
      trace(ray);
      if (ray_.distance > 0) color = color * 0.9f;
    }
    return color;
  }

  void trace(const Ray& ray) {
    ++rays_;
    const Hit hit = intersector_.closest(ray);
    if (hit.missed())
      miss(ray);
    else if (scene_.models[hit.model].is_procedural())
      hit_sphere(ray, hit);
    else
      hit_triangle(ray, hit);
  }

  void miss(const Ray& ray) {
    ray_.color = {};
    if (uniforms_.has_sky)
      ray_.color = mix(Vec(1), Vec(0.5f, 0.7f, 1), 0.5f * (normalize(ray.direction).y + 1.0f));
    ray_.distance = -1;
  }

  void hit_sphere(const Ray& ray, const Hit& hit) {
    const scenes::Model& model = scene_.models[hit.model];
    const Vec normal = (ray.origin + ray.direction * hit.t - model.center) / Vec(model.radius);
    const Material& material = scene_.materials[size_t(model.vertices[model.indices[0]].material)];
    const float u = (std::atan2(normal.x, normal.z) + kPi) / (2 * kPi),
                v = 1 - (std::asin(normal.y) + kPi / 2) / kPi;
    scatter(ray_, material, texture_color(scene_, material, u, v), ray.direction, normal, hit.t);
    ray_.normal = normal;
  }

  void hit_triangle(const Ray& ray, const Hit& hit) {
    const Surface surface = surface_of(scene_, hit);
    const bool keep_point = workload_ != Workload::PathTracing;
    const bool turn = keep_point && dot(ray.direction, surface.normal) > 0;
    const Vec normal = turn ? -surface.normal : surface.normal;
    const Vec texel = texture_color(scene_, *surface.material, surface.u, surface.v);
    scatter(ray_, *surface.material, texel, ray.direction, normal, hit.t);
    if (!keep_point) return;
    ray_.scatter = ray.origin + ray.direction * hit.t;
    ray_.normal = normal;
  }

  const scenes::Scene& scene_;
  Workload workload_;
  scenes::FrameUniforms uniforms_;
  Intersector& intersector_;
  Payload ray_;
  uint32_t rays_ = 0;
};

}  // namespace

ReferenceResult render(const scenes::Scene& scene, Workload workload, const scenes::RenderParams& params,
                       Intersector& intersector) {
  GLINT_CHECK(scene.instances.empty(), "the reference renders models in world coordinates, not {} instances",
              scene.instances.size());
  return Renderer(scene, workload, params, intersector).run();
}

}  // namespace glint::reference
