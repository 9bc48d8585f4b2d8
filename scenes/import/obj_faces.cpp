// Reads the elements and faces of an OBJ text with the library, on several threads.
// SPDX-License-Identifier: Apache-2.0
#include "scenes/import/obj_faces.h"

#include <cstddef>
#include <istream>
#include <streambuf>
#include <string_view>
#include <tiny_obj_loader.h>

#include "base/diagnostics.h"
#include "base/parallel_ranges.h"
#include "scenes/import/number_table.h"

namespace glint::scenes {
namespace {

// Lets a stream read a text where it lies.
class TextBuffer : public std::streambuf {
 public:
  explicit TextBuffer(std::string_view text) {
    char* begin = const_cast<char*>(text.data());  // A stream that only reads does not write there.
    setg(begin, begin, begin + text.size());
  }
};

// Gives NumberTable the corners of a chunk.
struct Corners {
  const std::vector<ObjCorner>& list;
  uint32_t hash(uint32_t number) const {
    const ObjCorner& corner = list[number];
    uint64_t state = uint32_t(corner.position) * 0x9e3779b97f4a7c15;
    for (const int32_t word : {corner.coordinate, corner.normal, corner.material})
      state = (state ^ uint32_t(word)) * 0xff51afd7ed558ccd;
    return uint32_t(state >> 32);
  }
  bool same(uint32_t one, uint32_t other) const { return list[one] == list[other]; }
};

// Takes what the library reads in one chunk.
class ChunkReader {
 public:
  // `line` counts the lines about materials above the chunk.
  ChunkReader(const ObjChunk& chunk, std::span<const int32_t> material_of, size_t line, ObjMesh& mesh,
              ObjFaces& out, const std::string& path)
      : chunk_(chunk), material_of_(material_of.subspan(line)), mesh_(mesh), out_(out), path_(path) {
    // Most faces are triangles, and a closed mesh has half as many vertices. Lists that grow would touch
    // memory twice, which threads do in turns.
    out_.triangles.reserve(3 * chunk.faces);
    out_.corners.reserve(chunk.faces);
  }

  void read() {
    tinyobj::callback_t calls;
    calls.vertex_cb = [](void* reader, float x, float y, float z, float) {
      of(reader).add(kPosition, of(reader).mesh_.positions, {x, y, z});
    };
    calls.texcoord_cb = [](void* reader, float u, float v, float) {
      of(reader).add(kCoordinate, of(reader).mesh_.coordinates, {u, v});
    };
    calls.normal_cb = [](void* reader, float x, float y, float z) {
      of(reader).add(kNormal, of(reader).mesh_.normals, {x, y, z});
    };
    calls.index_cb = [](void* reader, tinyobj::index_t* corners, int count) {
      of(reader).add_face({corners, size_t(count)});
    };
    TextBuffer buffer(chunk_.text);
    std::istream stream(&buffer);
    std::string error;
    if (!tinyobj::LoadObjWithCallback(stream, calls, this, nullptr, nullptr, &error)) fail(error);
    if (count_ != chunk_.count) fail("the library reads other elements in it");
  }

 private:
  enum List { kPosition, kCoordinate, kNormal };  // in the order of ObjCounts

  static ChunkReader& of(void* reader) { return *static_cast<ChunkReader*>(reader); }

  [[noreturn]] void fail(const std::string& why) const {
    throw UserError({path_}, "this OBJ file cannot be read: " + why, "expected a Wavefront OBJ file");
  }

  template <class Element>
  void add(List list, std::vector<Element>& elements, const Element& element) {
    if (count_[list] == chunk_.count[list]) fail("the library reads more elements in it");
    elements[chunk_.above[list] + count_[list]++] = element;
  }

  // The library gives a corner's numbers as they stand in the text: from 1 on, or counted back from the
  // element that stands last above the face. It gives 0 where there is none.
  int32_t index(int number, List list, size_t count) const {
    const int64_t above = int64_t(chunk_.above[list] + count_[list]);
    const int64_t at = number < 0 ? above + number : int64_t{number} - 1;
    if (at < -1 || at >= int64_t(count)) fail("one of its corners names nothing");
    return int32_t(at);
  }

  void add_face(std::span<const tinyobj::index_t> corners) {
    while (line_ < chunk_.material_lines.size() && chunk_.material_lines[line_].faces_above <= faces_)
      ++line_;
    ++faces_;
    if (corners.size() < 3) return;
    const uint32_t first = corner(corners[0]);
    for (uint32_t k = 1, previous = 0; k < corners.size(); ++k) {
      const uint32_t number = corner(corners[k]);
      if (k > 1) out_.triangles.insert(out_.triangles.end(), {first, previous, number});
      previous = number;
    }
  }

  uint32_t corner(const tinyobj::index_t& named) {
    const ObjCorner corner{.position = index(named.vertex_index, kPosition, mesh_.positions.size()),
                           .coordinate = index(named.texcoord_index, kCoordinate, mesh_.coordinates.size()),
                           .normal = index(named.normal_index, kNormal, mesh_.normals.size()),
                           .material = material_of_[line_]};
    if (corner.position < 0) fail("one of its corners names no vertex");
    const auto next = uint32_t(out_.corners.size());
    out_.corners.push_back(corner);
    const uint32_t number = table_.first_of(next);
    if (number != next) out_.corners.pop_back();
    return number;
  }

  const ObjChunk& chunk_;
  std::span<const int32_t>
      material_of_;  // of each line about materials, from the last one above the chunk on
  ObjMesh& mesh_;
  ObjFaces& out_;
  const std::string& path_;
  ObjCounts count_{};  // elements read so far
  uint64_t faces_ = 0;
  size_t line_ = 0;  // lines about materials above the face
  NumberTable<Corners> table_{Corners{out_.corners}};
};

}  // namespace

ObjMesh read_obj(std::span<const ObjChunk> chunks, std::span<const int32_t> material_of,
                 const std::string& path, uint32_t threads) {
  ObjMesh mesh;
  mesh.faces.resize(chunks.size());
  std::vector<size_t> lines_above;
  size_t lines = 0;
  for (const ObjChunk& chunk : chunks) lines_above.push_back(lines), lines += chunk.material_lines.size();
  if (!chunks.empty()) {
    const ObjChunk& last = chunks.back();
    mesh.positions.resize(last.above[0] + last.count[0]);
    mesh.coordinates.resize(last.above[1] + last.count[1]);
    mesh.normals.resize(last.above[2] + last.count[2]);
  }
  parallel_ranges(chunks.size(), 1, threads, [&](size_t i, size_t) {
    ChunkReader(chunks[i], material_of, lines_above[i], mesh, mesh.faces[i], path).read();
  });
  return mesh;
}

}  // namespace glint::scenes
