// Cuts the text of an OBJ file into chunks that threads read side by side, and finds its mistakes.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace glint::scenes {

// Counts the elements that a corner "v/vt/vn" names: vertices, texture coordinates and normals.
using ObjCounts = std::array<uint64_t, 3>;

// Is a line that names a material or a library of materials: "usemtl" or "mtllib".
struct ObjMaterialLine {
  std::string_view text;     // without the line's end
  uint64_t faces_above = 0;  // faces with a corner that stand above it in its chunk
};

// Is a run of whole lines. Its views are as valid as the text that it was cut from.
struct ObjChunk {
  std::string_view text;
  ObjCounts above{}, count{};  // elements above the chunk, and in it
  uint64_t lines = 0;
  uint64_t faces = 0;  // those with a corner
  std::vector<ObjMaterialLine> material_lines;
};

// Returns the chunks of the text in order, each of at least `chunk_bytes` but the last. A line ends at "\n",
// "\r\n" or "\r", as in the OBJ library. Throws UserError with the line of the first mistake: the library
// reads a coordinate that is no number as 0, counts at most 255 corners of a face, and does not look whether
// a corner names a vertex. `path` is for the message. Up to `threads` threads of the host look.
std::vector<ObjChunk> checked_chunks(std::string_view text, const std::string& path, uint32_t threads,
                                     size_t chunk_bytes);

}  // namespace glint::scenes
