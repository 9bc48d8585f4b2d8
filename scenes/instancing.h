// Finds models that are affine copies of another one and makes them instances of it.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "scenes/scene.h"

namespace glint::scenes {

// Returns the 3x4 matrix that moves every vertex of `from` onto the vertex of `to` with the same index, or
// nothing when there is no such matrix. Vertices may differ by a hundred-thousandth of the copy's size, plus
// what floats resolve at their place. Normals must follow the matrix, too.
std::optional<Affine> affine_between(const Model& from, const Model& to);

// Removes each model that has the triangles, coordinates and materials (by value) of an earlier one and is an
// affine copy of it. Lists every remaining and removed model in Scene::instances, in the order of the models.
// Nothing changes when there are no copies, or when the scene already has instances.
void share_copies(Scene& scene);

}  // namespace glint::scenes
