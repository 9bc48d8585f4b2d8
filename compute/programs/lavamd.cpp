// Computes the forces of particles on each other in boxes of space, as in molecular dynamics with a cut-off.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

constexpr uint32_t kParticles = 100, kNone = ~0u;  // particles of a box
constexpr float kTwiceAlphaSquared = 0.5f;         // twice the square of 0.5

struct Particle {
  float x, y, z, half_square;
};

// Returns 27 boxes for each box: itself and those around it.
std::vector<uint32_t> neighbours_of(int32_t side) {
  std::vector<uint32_t> out;
  const auto number = [&](int32_t x, int32_t y, int32_t z) {
    const bool is_inside = x >= 0 && y >= 0 && z >= 0 && x < side && y < side && z < side;
    return is_inside ? uint32_t((z * side + y) * side + x) : kNone;
  };
  for (int32_t box = 0; box < side * side * side; ++box)
    for (int32_t k = 0; k < 27; ++k)
      out.push_back(
          number(box % side + k % 3 - 1, box / side % side + k / 3 % 3 - 1, box / (side * side) + k / 9 - 1));
  return out;
}

struct Particles {
  std::vector<Particle> places;
  std::vector<float> charges;
};

// Adds what the particles of a box do to one particle, in the kernel's order.
void add_box(const Particle& mine, const Particles& all, uint32_t box, float* force) {
  for (uint32_t j = box * kParticles; j < (box + 1) * kParticles; ++j) {
    const Particle& other = all.places[j];
    const float dot = mine.x * other.x + mine.y * other.y + mine.z * other.z,
                u = std::exp(-kTwiceAlphaSquared * (mine.half_square + other.half_square - dot)),
                scale = 2.0f * all.charges[j] * u;
    force[0] += scale * (mine.x - other.x);
    force[1] += scale * (mine.y - other.y);
    force[2] += scale * (mine.z - other.z);
    force[3] += all.charges[j] * u;
  }
}

}  // namespace

void lavamd(Host& host, Size size) {
  const int32_t side = size == Size::Full ? 10 : 2;
  const uint32_t boxes = uint32_t(side * side * side), count = boxes * kParticles;
  Particles all;
  for (uint32_t i = 0; i < count; ++i) {
    const float x = host.random.between(0.1f, 1), y = host.random.between(0.1f, 1),
                z = host.random.between(0.1f, 1);
    all.places.push_back({x, y, z, 0.5f * (x * x + y * y + z * z)});
    all.charges.push_back(host.random.between(0.1f, 1));
  }
  const std::vector<uint32_t> neighbours = neighbours_of(side);
  const auto forces = host.buffer<float>("forces", size_t(count) * 4);
  struct {
    uint32_t particles;
    float twice_alpha_squared;
  } const constants{kParticles, kTwiceAlphaSquared};
  host.launch("lavamd", {boxes, 1, 1},
              {host.buffer("places", all.places), host.buffer("charges", all.charges),
               host.buffer("neighbours", neighbours), forces},
              constants);
  std::vector<float> expected(size_t(count) * 4);
  for (uint32_t i = 0; i < count; ++i)
    for (uint32_t k = 0; k < 27; ++k)
      if (const uint32_t box = neighbours[i / kParticles * 27 + k]; box != kNone)
        add_box(all.places[i], all, box, &expected[size_t(i) * 4]);
  host.check("forces", forces, expected, 1e-4);  // exp() may differ in its last bits.
}

}  // namespace glint::compute
