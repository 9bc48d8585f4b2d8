// A scene made of all the OBJ files of a folder, one model a file, with its rules of colours by file name.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "scenes/scene.h"

namespace glint::scenes {

// All materials of a file whose name (without .obj) contains one of `parts` become `material`.
struct NameRule {
  std::vector<std::string> parts;
  Material material;
};

struct FolderRules {
  std::vector<std::string>
      folders;  // candidates below the assets folder; its own name is one, for the folder itself
  bool textures = false;
  float scale = 1;                    // about the origin
  std::string skip = {};              // files whose name contains this are left out; "" = none
  std::vector<NameRule> colors = {};  // the first that matches
  // What no name rule can say: gets the file's name and its materials, after `colors`.
  std::function<void(const std::string& name, std::span<Material> materials)> recolor = {};
};

// Appends the files in the order of their names. Files without triangles give no model. A table
// `instances.tsv` in the folder lists further files as affine copies: name, file, 3x4 matrix in rows. Sets
// form and note: the original has a material library beside every OBJ file, so a library alone says that its
// OBJ file is absent and the scene "partial". UserError when no folder holds an OBJ file.
void load_folder(Scene& scene, const LoadOptions& options, const FolderRules& rules);

// The first of `folders` below `assets` that holds OBJ files, or "".
std::string find_folder(const std::string& assets, const std::vector<std::string>& folders);

// A colour of 0 to 255, over 256 as the application has it.
Material paint(int r, int g, int b);

// Appends a copy of `part`, moved: normals by the inverse transpose, normalised; every material `material`,
// or the part's own when that is negative.
void append_copy(Model& model, const Model& part, const Affine& matrix, int32_t material);

}  // namespace glint::scenes
