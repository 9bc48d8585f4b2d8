// Scenes of files that LumiBench does not know: one OBJ model, or a glTF scene with its nodes, materials and
// camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/mesh.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Whether a scene's name is a file's: it ends in .obj, .gltf or .glb.
bool names_scene_file(const std::string& name);

// Form "file". A file without a camera gets one that sees all of it; one without lamps, a sky. UserError as
// the loaders'.
Scene load_scene_file(const std::string& path, const LoadOptions& options);

// A glTF 2.0 file's default scene, in the file's units. A mesh is a model, a node with a mesh an instance.
// Materials: base colour (factor and texture), metals with their roughness as fuzziness, emission as a light,
// KHR_materials_transmission as a dielectric, alpha masks. The first camera and the first point or spot light
// are used. Not read, and said in the scene's note: skins, morph targets, blending, vertex colours, other
// maps. UserError: not readable, a required extension unknown, primitives other than triangles, accessors out
// of range.
Scene load_gltf(const std::string& path, const LoadOptions& options);

// All instances of triangles as one model in world coordinates.
Model flattened(const Scene& scene);

// Of every instance, procedural ones included.
Bounds world_bounds(const Scene& scene);

}  // namespace glint::scenes
