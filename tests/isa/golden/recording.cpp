// Reads recordings and runs their forms.
// SPDX-License-Identifier: Apache-2.0
#include "tests/isa/golden/recording.h"

#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <zstd.h>

#include "frontend/ptx/ptx.h"
#include "pipeline/functional_machine.h"
#include "pipeline/kernel_launch.h"

namespace glint::golden {
namespace {

std::string content_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(fmt::format("cannot read {}", path.string()));
  return {std::istreambuf_iterator<char>(in), {}};
}

std::string unpacked(const std::filesystem::path& path) {
  const std::string packed = content_of(path);
  std::string out(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  if (ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) != out.size())
    throw UserError(fmt::format("{} is damaged", path.string()));
  return out;
}

uint32_t bytes_of(const std::string& type) {
  if (type == "pred") return 1;
  if (type.ends_with("x2")) return 4;
  return uint32_t(std::stoul(type.substr(type.find_first_of("0123456789")))) / 8;
}

std::vector<Array> arrays_of(const nlohmann::json& list) {
  std::vector<Array> out;
  for (const nlohmann::json& a : list) out.push_back({a["type"], a["bytes"], a["offset"]});
  return out;
}

}  // namespace

std::string contents(const std::filesystem::path& path) {
  const std::filesystem::path packed = path.string() + ".zst";
  return std::filesystem::exists(packed) ? unpacked(packed) : content_of(path);
}

uint64_t Recording::value(const std::string& data, const Array& array, uint32_t lane) {
  uint64_t value = 0;
  std::memcpy(&value, data.data() + array.offset + size_t{lane} * array.bytes, array.bytes);
  return array.type == "pred" ? value != 0 : value;
}

Recording load_folder(const std::filesystem::path& folder) {
  const nlohmann::json manifest = nlohmann::json::parse(content_of(folder / "manifest.json"));
  Recording out;
  out.lanes = manifest["lanes"];
  out.inputs = contents(folder / "inputs.bin");
  out.outputs = contents(folder / "outputs.bin");
  for (const nlohmann::json& op : manifest["ops"])
    out.forms.push_back({op["op"], op["ptx"], arrays_of(op["inputs"]), arrays_of(op["outputs"])});
  return out;
}

Recording load_extract(const std::filesystem::path& folder) {
  Recording out;
  out.lanes = 32;
  const std::string lanes = unpacked(folder / "lanes.bin.zst");
  const std::string text = content_of(folder / "forms.txt");
  std::istringstream forms(text);
  size_t at = 0;
  for (std::string line; std::getline(forms, line);) {
    if (line.empty() || line.starts_with("//")) continue;
    std::vector<std::string> part;  // op, input types, output types, text; tab-separated
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, '\t');) part.push_back(field);
    Form form{part[0], part[3], {}, {}};
    for (size_t side = 0; side < 2; ++side) {
      std::istringstream types(part[1 + side]);
      for (std::string type; types >> type;) {
        (side == 0 ? form.inputs : form.outputs).push_back({type, bytes_of(type), at});
        at += size_t{bytes_of(type)} * out.lanes;
      }
    }
    out.forms.push_back(std::move(form));
  }
  if (at != lanes.size())
    throw UserError(
        fmt::format("{}: {} bytes of lanes, the forms take {}", folder.string(), lanes.size(), at));
  out.inputs = out.outputs = lanes;
  return out;
}

namespace {

constexpr const char* kInputs[] = {"A", "B", "C", "E"};
constexpr const char* kOutputs[] = {"D0", "D1"};

const char* register_type(const Array& a) {
  if (a.type == "pred") return "pred";
  return a.bytes == 8 ? "b64" : a.bytes == 4 ? "b32" : "b16";
}

}  // namespace

std::string kernel_text(const Form& form) {
  std::string parameters, declarations, loads, stores;
  const auto parameter = [&](const std::string& name) {
    parameters += fmt::format("{}.param .u64 p_{}", parameters.empty() ? "" : ", ", name);
  };
  const auto address = [](const std::string& name, uint32_t bytes) {
    return fmt::format("  ld.param.u64 %at, [p_{0}];\n  mad.wide.u32 %at, %index, {1}, %at;\n", name, bytes);
  };
  for (size_t i = 0; i < form.inputs.size(); ++i) {
    const Array& a = form.inputs[i];
    parameter(kInputs[i]);
    declarations += fmt::format("  .reg .{} {};\n", register_type(a), kInputs[i]);
    loads +=
        address(kInputs[i], a.bytes) + fmt::format("  ld.global.b{} {}, [%at];\n", a.bytes * 8, kInputs[i]);
    // No op may depend on the upper half of a register that holds a 16-bit value, so it is filled with other
    // bits.
    if (a.bytes == 2) loads += fmt::format("  or.b32 {0}, {0}, 0x7fc50000;\n", kInputs[i]);
  }
  for (size_t i = 0; i < form.outputs.size(); ++i) {
    const Array& a = form.outputs[i];
    parameter(kOutputs[i]);
    declarations += fmt::format("  .reg .{} {};\n", register_type(a), kOutputs[i]);
    stores += address(kOutputs[i], a.bytes);
    if (a.type == "pred")
      stores += fmt::format("  selp.u32 %bit, 1, 0, {};\n  st.global.b8 [%at], %bit;\n", kOutputs[i]);
    else
      stores += fmt::format("  st.global.b{} [%at], {};\n", a.bytes * 8, kOutputs[i]);
  }
  parameter("TMP");
  return fmt::format(
      ".version 8.0\n.target sm_90\n.address_size 64\n.visible .entry form({})\n{{\n{}"
      "  .reg .b64 %at, TMP;\n  .reg .b32 %index, %thread, %bit, SHM;\n  .reg .pred PP;\n  .shared .align 8 "
      ".b8 scratch[256];\n"
      "  mov.u32 %thread, %tid.x;\n  mov.u32 %index, %ctaid.x;\n  mad.lo.u32 %index, %index, 32, "
      "%thread;\n{}{}  mov.u64 TMP, %at;\n"
      "  mov.u32 SHM, scratch;\n  mad.lo.u32 SHM, %thread, 8, SHM;\n  {}\n{}  ret;\n}}\n",
      parameters, declarations, loads, address("TMP", 8), form.text, stores);
}

void use_path(pipeline::KernelWorld& world, isa::Path path) {
  for (exec::Step& step : world.image.code)
    step.row = &isa::op_table(path)[step.inst.op], step.run = step.row->run;
}

Outcome run(const Recording& recording, const Form& form) {
  Outcome out;
  frontend::Kernel kernel;
  try {
    frontend::PtxOptions options;
    options.check_types = false;
    kernel = frontend::compile_ptx(kernel_text(form), form.op, "form", options);
  } catch (const Error& error) {
    out.refused = error.what();
    return out;
  }
  for (int p = 0; p < int(isa::Path::Count); ++p) {
    const isa::Path path = isa::Path(p);
    if (!isa::is_supported(path)) continue;
    pipeline::KernelWorld world(kernel);
    use_path(world, path);
    world.set_grid({{recording.lanes / 32, 1, 1}, {32, 1, 1}, 0});
    std::vector<std::vector<std::byte>> arguments;
    std::vector<Address> at;
    const auto buffer = [&](const char* name, uint64_t bytes) {
      at.push_back(world.memory().allocate(name, bytes));
      arguments.push_back(pipeline::KernelWorld::argument(at.back()));
      return at.back();
    };
    for (const Array& a : form.inputs)
      world.memory().write(buffer("input", uint64_t{recording.lanes} * a.bytes),
                           recording.inputs.data() + a.offset, uint64_t{recording.lanes} * a.bytes);
    const size_t first_output = at.size();
    for (const Array& a : form.outputs) buffer("output", uint64_t{recording.lanes} * a.bytes);
    buffer("scratch", uint64_t{recording.lanes} * 8);
    world.set_arguments(arguments);
    pipeline::run_functional(world.world, 100'000, {});
    out.paths.push_back(path);
    std::vector<std::vector<uint64_t>> values;
    for (size_t i = 0; i < form.outputs.size(); ++i) {
      const uint64_t bytes = uint64_t{recording.lanes} * form.outputs[i].bytes;
      const std::byte* from = world.memory().find(at[first_output + i], bytes);
      const std::string data(reinterpret_cast<const char*>(from), bytes);
      Array array = form.outputs[i];
      array.offset = 0;
      values.emplace_back();
      for (uint32_t lane = 0; lane < recording.lanes; ++lane)
        values.back().push_back(Recording::value(data, array, lane));
    }
    out.outputs.push_back(std::move(values));
  }
  return out;
}

}  // namespace glint::golden
