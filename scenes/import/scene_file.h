// Loads scenes of files that LumiBench does not know: one OBJ model, or a glTF scene with its nodes,
// materials and camera.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "scenes/mesh.h"
#include "scenes/scene.h"

namespace glint::scenes {

// Returns whether a scene's name is that of a file: it ends in .obj, .gltf or .glb.
bool names_scene_file(const std::string& name);

// Loads a scene of the form "file". A file without a camera gets one that sees all of it, and a file without
// lamps gets a sky. Throws UserError as the loaders do.
Scene load_scene_file(const std::string& path, const LoadOptions& options);

// Loads a glTF 2.0 file's default scene, in the file's units. Each mesh becomes a model, and each node with a
// mesh becomes an instance. These parts of materials are read: base colour (factor and texture), metals with
// their roughness as fuzziness, emission as a light, KHR_materials_transmission as a dielectric, and alpha
// masks. The first camera and the first point or spot light are used. Skins, animations, morph targets,
// vertex colours and other maps are not read, and blending becomes a mask; the scene's note says so for
// skins, animations and blending.
// Throws UserError when the file is not readable, requires an unknown extension, or has primitives other than
// triangles or accessors out of range.
Scene load_gltf(const std::string& path, const LoadOptions& options);

// Returns all instances of triangles as one model in world coordinates.
Model flattened(const Scene& scene);

// Returns the bounds of a box after a transform. The difference of its corners is not finite where the
// transform leaves the floats.
Bounds moved(const Bounds& box, const Affine& m);

// Returns the bounds of every instance, procedural ones included.
Bounds world_bounds(const Scene& scene);

}  // namespace glint::scenes
