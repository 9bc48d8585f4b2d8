// Makes a scene of all the OBJ files of a folder: one model per file, with colours by file name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// Says that all materials of a file whose name (without .obj) contains one of `parts` become `material`.
struct NameRule {
  std::vector<std::string> parts;
  Material material;
};

struct FolderRules {
  bool textures = false;
  float scale = 1;                    // scales every position about the origin
  std::string skip = {};              // Files whose name contains this are left out; empty: no file is.
  std::vector<NameRule> colors = {};  // the first rule that matches applies
  // Does what no name rule can say. It is called after `colors` with the file's name and its materials.
  std::function<void(const std::string& name, std::span<Material> materials)> recolor = {};
};

// Appends the files in the order of their names. Files without triangles give no model. A table
// `instances.tsv` in the folder lists further models as affine copies of files: name, file, 3x4 matrix in
// rows. Sets form and note. In the original, every OBJ file has a material library beside it. So a library
// alone says that its OBJ file is absent and the scene is "partial".
void load_folder(Scene& scene, const std::string& folder, const LoadOptions& options,
                 const FolderRules& rules);

// Returns a material of a colour given as 0 to 255. The components are divided by 256, as in the application.
Material paint(int r, int g, int b);

// Appends a copy of `part`, moved by `matrix`. Normals are moved by the inverse transpose and normalised.
// Every vertex gets `material`, or keeps its own material when `material` is negative.
void append_copy(Model& model, const Model& part, const Affine& matrix, int32_t material);

}  // namespace glint::scenes
