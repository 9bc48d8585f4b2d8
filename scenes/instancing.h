// Finds models that are affine copies of another one and makes them instances of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "scenes/scene.h"

namespace glint::scenes {

// The 3x4 matrix that moves every vertex of `from` onto the one of `to` with the same index, to a
// hundred-thousandth of the copy's size and what floats resolve there; nothing when there is none. Normals
// must follow it too.
std::optional<Affine> affine_between(const Model& from, const Model& to);

// Removes each model that has the triangles, coordinates and materials (by value) of an earlier one and is an
// affine copy of it, and lists every remaining and removed one in Scene::instances, in the order of the
// models. Nothing changes when there are no copies. Scenes that already have instances are left alone.
void share_copies(Scene& scene);

}  // namespace glint::scenes
