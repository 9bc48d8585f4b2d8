// Sculpts clothed people of limbs and ellipsoids with a budget of triangles, for generated scenes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>

#include "scenes/generate/solids.h"

namespace glint::scenes {

// Names the parts of a figure, which may differ in material or be models of their own.
enum class FigurePart : uint8_t { Skin, Eyes, Hair, Top, Legs, Shoes };
inline constexpr std::array kFigureParts = {FigurePart::Skin, FigurePart::Eyes, FigurePart::Hair,
                                            FigurePart::Top,  FigurePart::Legs, FigurePart::Shoes};

// Describes a person one unit tall who stands on y = 0 and looks along +z.
struct Figure {
  std::array<Vec3, 2> hands = {{{-0.19f, 0.46f, 0.06f}, {0.19f, 0.46f, 0.06f}}};  // at -x and at +x
  float girth = 1;     // factor of the widths of the body
  bool skirt = false;  // instead of trousers
  bool long_hair = false;
};

// Adds one part. The frame's axes are as long as the figure is tall; its origin lies between the feet. The
// number of triangles is met within about a fifth, because it follows from the part's estimated surface. Up
// to `threads` threads of the host make it.
void add_figure_part(Model& model, const Frame& frame, const Figure& figure, FigurePart part,
                     uint64_t triangles, int32_t material, uint32_t threads = 1);

// Adds all parts of a figure, whose materials are in the order of kFigureParts. They share the triangles by
// their surfaces.
void add_figure(Model& model, const Frame& frame, const Figure& figure, uint64_t triangles,
                const std::array<int32_t, kFigureParts.size()>& materials);

}  // namespace glint::scenes
