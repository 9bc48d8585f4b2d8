// Writes the obvious description: resources that the shaders declare, records in the order of the files.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/defaults.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <map>
#include <set>
#include <utility>

#include "pipeline/description/modules.h"
#include "pipeline/description/usual_values.h"

namespace glint::pipeline {
namespace {

namespace fs = std::filesystem;
using frontend::BindingKind;
using frontend::BlockType;

// Choice: these defaults are the side of a picture and the number of elements of run-time arrays.
constexpr uint32_t kSide = 256, kElements = 65536;
// Choice: shaders that add to an address find so many elements behind it.
constexpr uint32_t kTargets = 1024;

// Returns the number type that all of a block is made of, or u32 when there is no such type.
std::string number_of(const BlockType& type) {
  if (type.kind == BlockType::Kind::Numbers) return type.number;
  if (type.kind == BlockType::Kind::Array) return number_of(type.element[0]);
  std::string found;
  for (const auto& member : type.members) {
    const std::string each = number_of(member.type);
    if (!found.empty() && each != found) return "u32";
    found = each;
  }
  return found.empty() ? "u32" : found;
}

uint32_t default_bytes(const BlockType& block) {
  uint32_t bytes = block.bytes;
  if (!block.members.empty()) {
    const auto& last = block.members.back();
    if (last.type.kind == BlockType::Kind::Array && last.type.count == 0)
      bytes = last.offset + kElements * std::max(1u, last.type.stride);
  }
  return (bytes + 15) / 16 * 16;
}

const char* kScene = R"(
# A floor and a pyramid, as seen from (0, 1, 4) towards the origin. Replace by file = "mesh.obj" if you like.
[[bottom_level]]
name = "triangles"
[[bottom_level.geometry]]
vertices = [[-3, -0.5, -3], [3, -0.5, -3], [3, -0.5, 3], [-3, -0.5, 3],
            [-0.7, -0.5, -0.7], [0.7, -0.5, -0.7], [0.7, -0.5, 0.7], [-0.7, -0.5, 0.7], [0, 0.8, 0]]
indices = [[0, 1, 2], [0, 2, 3], [4, 8, 5], [5, 8, 6], [6, 8, 7], [7, 8, 4]]
opaque = {}
)";
const char* kBoxes = R"(
# Boxes for the intersection shader; its hit group stands at record {}.
[[bottom_level]]
name = "boxes"
[[bottom_level.geometry]]
aabbs = [[-0.5, -0.5, -0.5, 0.5, 0.5, 0.5]]
opaque = {}
)";

class Writer {
 public:
  Writer(const Modules& modules, const std::string& folder, const frontend::GlslOptions& glsl)
      : modules_(modules), folder_(folder), glsl_(glsl) {}

  std::string run() {
    out_ =
        "# Written by `glint init`; docs/pipelines.md explains every key. Paths start at this file's "
        "folder.\n";
    write_compile();
    write_stages();
    write_launch();
    write_push_constants();
    write_specialization();
    for (const auto& [place, use] : modules_.bindings()) write_binding(use);
    write_targets();
    if (has_structures_) write_structures();
    return out_;
  }

 private:
  template <class... T>
  void line(fmt::format_string<T...> text, T&&... values) {
    out_ += fmt::format(text, std::forward<T>(values)...) + "\n";
  }

  std::string from_folder(const std::string& path) const { return path_from(path, folder_); }
  std::string path_of(const ShaderModule& m) const { return from_folder(m.path); }

  void write_compile() {
    if (glsl_.include_dirs.empty() && glsl_.defines.empty()) return;
    std::vector<std::string> folders, macros;
    for (const std::string& folder : glsl_.include_dirs) folders.push_back(quoted(from_folder(folder)));
    for (const auto& [name, value] : glsl_.defines)
      macros.push_back(fmt::format("{} = {}", name, quoted(value)));
    line("\n[compile]");
    if (!folders.empty()) line("include = [{}]", fmt::join(folders, ", "));
    if (!macros.empty()) line("define = {{ {} }}", fmt::join(macros, ", "));
  }

  void write_record_data(const std::vector<const ShaderModule*>& shaders) {
    for (const ShaderModule* m : shaders)
      if (m && !m->reflection.shader_record.members.empty()) {
        for (const std::string& member : frontend::describe_members(m->reflection.shader_record))
          line("# {}", member);
        line("data = {}", value_of("", m->reflection.shader_record));
        return;
      }
  }

  void write_stages() {
    struct Hit {
      const ShaderModule *closest = nullptr, *any = nullptr, *intersection = nullptr;
    };
    std::vector<std::pair<std::string, Hit>> hits;
    const auto hit = [&](const ShaderModule& m) -> Hit& {
      const std::string stem = fs::path(m.path).stem().string();
      for (auto& [name, found] : hits)
        if (name == stem) return found;
      return hits.emplace_back(stem, Hit{}).second;
    };
    std::vector<const ShaderModule*> starts;
    for (const ShaderModule& m : modules_.all()) {
      switch (m.reflection.stage) {
        case isa::Stage::RayGeneration:
        case isa::Stage::Compute:
          starts.push_back(&m);
          break;
        case isa::Stage::ClosestHit:
          hit(m).closest = &m;
          break;
        case isa::Stage::AnyHit:
          hit(m).any = &m;
          break;
        case isa::Stage::Intersection:
          hit(m).intersection = &m;
          break;
        default:
          break;
      }
    }
    if (starts.size() != 1)
      throw UserError({}, fmt::format("{} ray generation or compute shaders among the files, expected one",
                                      starts.size()));
    start_ = starts[0];
    const bool is_compute = start_->reflection.stage == isa::Stage::Compute;
    line("\n[{}]\nshader = {}", is_compute ? "compute" : "raygen", quoted(path_of(*start_)));
    if (is_compute) return;
    write_record_data({start_});
    write_region("miss", isa::Stage::Miss);
    for (const auto& [name, h] : hits) {
      line("\n[[hit]]  # record {}", num_hits_);
      for (const auto& [key, m] :
           {std::pair{"closest_hit", h.closest}, {"any_hit", h.any}, {"intersection", h.intersection}})
        if (m) line("{} = {}", key, quoted(path_of(*m)));
      write_record_data({h.closest, h.any, h.intersection});
      if (h.intersection && box_record_ < 0) box_record_ = num_hits_;
      if (!h.intersection && triangle_record_ < 0) triangle_record_ = num_hits_;
      has_any_hit_ |= h.any != nullptr;
      ++num_hits_;
    }
    write_region("callable", isa::Stage::Callable);
  }

  void write_region(const char* key, isa::Stage stage) {
    int count = 0;
    for (const ShaderModule& m : modules_.all()) {
      if (m.reflection.stage != stage) continue;
      line("\n[[{}]]  # record {}\nshader = {}", key, count++, quoted(path_of(m)));
      write_record_data({&m});
    }
  }

  void write_launch() {
    if (start_->reflection.stage != isa::Stage::Compute) {
      line("\n[launch]\nsize = [{}, {}]  # rays in x and y", kSide, kSide);
      return;
    }
    const auto& size = start_->reflection.local_size;
    threads_ = size[1] * size[2] == 1 && !writes_picture() ? std::array<uint32_t, 2>{kElements, 1}
                                                           : std::array<uint32_t, 2>{kSide, kSide};
    line("\n[launch]\n# Blocks of {} x {} x {} threads.\ngroups = [{}, {}]", size[0], size[1], size[2],
         (threads_[0] + size[0] - 1) / size[0], (threads_[1] + size[1] - 1) / size[1]);
  }

  bool writes_picture() const {
    for (const auto& [place, use] : modules_.bindings())
      if (use.binding.kind == BindingKind::StorageImage && isa::num_coordinates(use.binding.shape) > 1)
        return true;
    return false;
  }

  void write_push_constants() {
    for (const ShaderModule& m : modules_.all()) {
      const BlockType& block = m.reflection.push_constants;
      if (block.members.empty()) continue;
      line("\n[push_constants]");
      for (const auto& member : block.members)
        line("{} = {}", member.name, value_of(member.name, member.type));
      return;
    }
  }

  void write_specialization() {
    std::set<std::string> written;
    for (const ShaderModule& m : modules_.all())
      for (const frontend::SpecConstant& c : m.constants) {
        const std::string name = c.name.empty() ? fmt::format("{}", c.id) : c.name;
        if (written.empty()) line("\n# Specialisation constants and their defaults.\n[specialization]");
        if (!written.insert(name).second) continue;
        line("# {} = {}  # constant_id {}, {}", name, default_text(c), c.id, c.number);
      }
  }

  void write_slot(const char* table, const frontend::Binding& b, const std::string& name, uint32_t element) {
    line("\n[[{}]]\nname = {}\nset = {}\nbinding = {}", table,
         quoted(element ? fmt::format("{}{}", name, element) : name), b.set, b.binding);
    if (b.count != 1)
      line("element = {}  # of {}", element,
           b.count ? fmt::format("{}", b.count) : std::string("as many as you like"));
  }

  void write_binding(const BindingUse& use) {
    const frontend::Binding& b = use.binding;
    const std::string name = b.name.empty() ? fmt::format("binding_{}_{}", b.set, b.binding) : b.name;
    for (uint32_t element = 0; element < std::max(1u, b.count); ++element) switch (b.kind) {
        case BindingKind::UniformBuffer:
        case BindingKind::StorageBuffer:
          write_buffer(b, name, element);
          break;
        case BindingKind::StorageImage:
          write_slot("image", b, name, element);
          line("size = [{}]", size_text(b, kSide, kSide));
          if (b.multisampled)
            line("samples = 4");
          else
            line("save = {}",
                 quoted(fmt::format("{}{}.png", name, element ? fmt::format("{}", element) : "")));
          break;
        case BindingKind::SampledImage:
          write_slot("image", b, name, element);
          line("init = \"checker\"  # or file = \"picture.png\"\nsize = [{}]", size_text(b, 64, 64));
          if (b.multisampled) line("samples = 4");
          if (b.texel == "f32") line("format = \"rgba8_unorm\"");
          line("filter = {}\nwrap = \"repeat\"", b.texel == "f32" ? "\"linear\"" : "\"nearest\"");
          break;
        case BindingKind::Sampler:
          write_slot("sampler", b, name, element);
          line("filter = \"linear\"\nwrap = \"repeat\"");
          break;
        case BindingKind::AccelerationStructure:
          write_slot("top_level", b, name, element);
          has_structures_ = true;
          write_instances();
          break;
        case BindingKind::Other:
          break;
      }
  }

  static std::string size_text(const frontend::Binding& b, uint32_t w, uint32_t h) {
    const int axes = isa::num_coordinates(b.shape);
    if (axes == 1) return fmt::format("{}", w);
    return axes == 3 && !isa::is_cube(b.shape) ? fmt::format("{}, {}, {}", w, h, 16)
                                               : fmt::format("{}, {}", w, h);
  }

  // Returns the first contents of a buffer. Meshes and materials of zeros would make pictures black or not
  // finite, so where there is a picture only buffers that look like results begin with zeros.
  std::string init_of(const std::string& name, const std::string& number) const {
    std::string small = name;
    std::transform(small.begin(), small.end(), small.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const auto has = [&](const char* word) { return small.find(word) != std::string::npos; };
    const bool is_result = has("out") || has("result") || has("accum") || has("sum") || has("hist");
    if (writes_picture() && !is_result && number == "f32") return "init = \"random\"  # zero, value, iota";
    if (writes_picture() && !is_result && has("ind")) return "init = \"iota\"  # zero, value, random";
    return "init = \"zero\"  # value, iota, random";
  }

  void write_buffer(const frontend::Binding& b, const std::string& name, uint32_t element) {
    write_slot("buffer", b, name, element);
    for (const std::string& member : frontend::describe_members(b.block)) line("# {}", member);
    if (b.kind == BindingKind::UniformBuffer)
      line("data = {}", value_of("", b.block));
    else
      write_contents(b.block, element ? fmt::format("{}{}", name, element) : name, name);
  }

  void write_contents(const BlockType& block, const std::string& name, const std::string& meaning,
                      uint32_t elements = 1) {
    const std::string number = number_of(block);
    const uint64_t bytes = std::max<uint64_t>(default_bytes(block), uint64_t{elements} * block.bytes);
    line("type = {}\nbytes = {}", quoted(number), bytes);
    if (has_targets("", block))
      line("data = {}", value_of("", block));
    else
      line("{}; or data = [...], or file = \"...\"", init_of(meaning, number));
    line("show = 8\nsave = {}", quoted(name + ".npy"));
  }

  // Returns a value of a block's member. Each address leads to a buffer of its member's name, which all
  // members of that name share.
  std::string value_of(const std::string& name, const BlockType& type) {
    return usual_value(name, type, kSide, [&](const std::string& member, const BlockType& target) {
      std::string buffer = member;
      const auto is_binding = [&](const auto& one) { return one.second.binding.name == buffer; };
      while (std::any_of(modules_.bindings().begin(), modules_.bindings().end(), is_binding))
        buffer += "_target";
      targets_.try_emplace(buffer, target);
      return buffer;
    });
  }

  void write_targets() {
    for (const auto& [name, block] : targets_) {
      line("\n# An address leads to this buffer.\n[[buffer]]\nname = {}", quoted(name));
      for (const std::string& member : frontend::describe_members(block)) line("# {}", member);
      write_contents(block, name, name, kTargets);
    }
  }

  void write_instances() {
    const bool only_boxes = box_record_ >= 0 && triangle_record_ < 0;
    if (!only_boxes) {
      line(
          "[[top_level.instance]]\nbottom_level = \"triangles\"\n# also: translate, rotate, scale or "
          "transform; custom_index, mask, flags");
      if (triangle_record_ > 0) line("sbt_offset = {}", triangle_record_);
    }
    if (box_record_ < 0) return;
    line("[[top_level.instance]]\nbottom_level = \"boxes\"");
    if (!only_boxes) line("translate = [1.5, 0, 0]");
    if (box_record_ > 0) line("sbt_offset = {}", box_record_);
  }

  void write_structures() {
    if (box_record_ < 0 || triangle_record_ >= 0) out_ += fmt::format(fmt::runtime(kScene), !has_any_hit_);
    if (box_record_ >= 0) out_ += fmt::format(fmt::runtime(kBoxes), box_record_, !has_any_hit_);
  }

  const Modules& modules_;
  const std::string folder_;
  const frontend::GlslOptions& glsl_;
  std::string out_;
  const ShaderModule* start_ = nullptr;
  std::array<uint32_t, 2> threads_{};
  int num_hits_ = 0, box_record_ = -1, triangle_record_ = -1;
  bool has_any_hit_ = false, has_structures_ = false;
  std::map<std::string, BlockType> targets_;  // of addresses, by the names of their buffers
};

}  // namespace

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (char c : text) out += c == '"' || c == '\\' ? std::string("\\") + c : std::string(1, c);
  return out + "\"";
}

std::string path_from(const std::string& path, const std::string& folder) {
  std::error_code failed;
  const fs::path relative = fs::proximate(path, folder.empty() ? "." : folder, failed);
  return failed || relative.empty() ? path : relative.string();
}

std::string default_description(const std::vector<std::string>& shaders, const std::string& folder,
                                const frontend::GlslOptions& glsl) {
  PipelineDescription description;
  for (const std::string& shader : shaders) description.shaders.push_back({shader, shader, "", glsl, {}});
  const Modules modules(description, {}, true);
  return Writer(modules, folder, glsl).run();
}

std::vector<std::string> with_companions(const std::string& shader) {
  std::vector<std::string> out{shader};
  if (frontend::stage_of_file(shader) != isa::Stage::RayGeneration) return out;
  const bool is_glsl = fs::path(shader).extension() == ".glsl";
  const fs::path rgen = is_glsl ? fs::path(shader).replace_extension() : fs::path(shader);
  for (const char* ending : {".rmiss", ".rchit", ".rahit", ".rint", ".rcall"}) {
    const fs::path beside = fs::path(rgen).replace_extension(std::string(ending) + (is_glsl ? ".glsl" : ""));
    std::error_code failed;
    if (fs::is_regular_file(beside, failed)) out.push_back(beside.string());
  }
  return out;
}

}  // namespace glint::pipeline
