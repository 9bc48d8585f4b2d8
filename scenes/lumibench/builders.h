// Declares the scenes' own constructors, one per file. Everybody else calls load_scene (scenes/scene.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>

#include "scenes/scene.h"

namespace glint::scenes {

// `original` is the file or the folder that holds the original scene, or empty where it is to be generated.
Scene build_weekend(const LoadOptions& options, const std::string& original);
Scene build_bunny(const LoadOptions& options, const std::string& original);
Scene build_mirror_box(const LoadOptions& options, const std::string& original);
Scene build_ship(const LoadOptions& options, const std::string& original);
Scene build_cornell(const LoadOptions& options, const std::string& original);
Scene build_sponza(const LoadOptions& options, const std::string& original);
Scene build_chestnut(const LoadOptions& options, const std::string& original);
Scene build_bathroom(const LoadOptions& options, const std::string& original);
Scene build_carnival(const LoadOptions& options, const std::string& original);
Scene build_fox(const LoadOptions& options, const std::string& original);
Scene build_party(const LoadOptions& options, const std::string& original);
Scene build_spring(const LoadOptions& options, const std::string& original);
Scene build_lands(const LoadOptions& options, const std::string& original);
Scene build_forest(const LoadOptions& options, const std::string& original);
Scene build_park(const LoadOptions& options, const std::string& original);
Scene build_car(const LoadOptions& options, const std::string& original);
Scene build_robot(const LoadOptions& options, const std::string& original);

// Returns the Cornell box of edge 555: 24 vertices and 12 triangles, open towards +z. The first four
// materials of its scene are those of add_cornell_materials().
Model make_cornell_box();
// Appends the box's materials: 0 red (right), 1 green (left), 2 white, 3 light.
void add_cornell_materials(Scene& scene);

// Return stand-ins for meshes that cannot be redistributed, in the coordinates of the originals before
// placement. Up to `threads` threads of the host make them.
Model make_bunny_stand_in(int32_t material, uint32_t threads);   // about 144,000 triangles; feet at y = 0
Model make_statue_stand_in(int32_t material, uint32_t threads);  // about 449,000 triangles; height about 600
// Returns a two-masted schooner of about 6,255 triangles, and appends its 11 materials to the scene.
Model make_schooner(Scene& scene);

// Appends a material to the scene and returns its index. Without a name it gets the one of its models, when
// the scene is complete (load_scene()).
int32_t add_material(Scene& scene, std::string name, const Material& material);

Material lambertian(float r, float g, float b);
Material metallic(float r, float g, float b, float fuzziness);
Material dielectric(float refraction_index);
Material diffuse_light(float r, float g, float b);

}  // namespace glint::scenes
