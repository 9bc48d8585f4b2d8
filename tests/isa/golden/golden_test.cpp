// Bits of every op that PTX has, compared with those recorded on a GPU, where the recordings are at hand.
// SPDX-License-Identifier: Apache-2.0
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <zstd.h>

#include "isa/paths.h"
#include "tests/isa/warp_fixture.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

std::string unpacked(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string packed{std::istreambuf_iterator<char>(in), {}};
  std::string out(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  REQUIRE(ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) == out.size());
  return out;
}

uint64_t value_at(const std::string& data, const nlohmann::json& operand, size_t lane) {
  const size_t bytes = operand["bytes"];
  uint64_t value = 0;
  std::memcpy(&value, data.data() + size_t(operand["offset"]) + lane * bytes, bytes);
  return operand["type"] == "pred" ? value != 0 : value;
}

// PTX leaves this remainder to the machine; ours is chosen (isa/ops/integer.cpp).
bool is_ours_to_choose(std::string_view op, uint64_t second) {
  return (op == "rem.s32" || op == "rem.u32") && second == 0;
}

}  // namespace

TEST_CASE("every op that PTX shares gives the bits of a GPU, but approximations and remainders of 0") {
  const auto folder = std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/ptx-golden";
  if (!std::filesystem::exists(folder / "manifest.json")) {
    WARN("SKIPPED: no recordings of a GPU beside the repository");
    return;
  }
  std::ifstream manifest_file(folder / "manifest.json");
  const nlohmann::json manifest = nlohmann::json::parse(manifest_file);
  const std::string inputs = unpacked(folder / "inputs.bin.zst"),
                    outputs = unpacked(folder / "outputs.bin.zst");
  std::set<std::string> compared;
  for (const nlohmann::json& form : manifest["ops"]) {
    const std::string name = form["op"];
    const int op = find_op(name);
    if (op < 0 || !is_value_op(op_table()[size_t(op)])) continue;
    if (name.find(".approx.") != std::string::npos) continue;  // ours are more accurate (isa/kernels.h)
    const OpRow& row = op_table()[size_t(op)];
    if (form["inputs"].size() + 1 != row.operands.count || form["outputs"].size() != 1) continue;
    compared.insert(name);
    const Inst inst = spread(row, uint16_t(op));
    size_t wrong = 0;
    std::string first;
    const size_t lanes = manifest["lanes"];
    for (size_t base = 0; base < lanes; base += kLanes) {
      WarpFixture w;
      w.warp.exec = kAllLanes;
      for (size_t i = 0; i < form["inputs"].size(); ++i)
        for (int lane = 0; lane < kLanes; ++lane)
          w.set(row.operands.kind[i + 1], inst.operand[i + 1], lane,
                value_at(inputs, form["inputs"][i], base + size_t(lane)));
      row.run(w.warp, inst);
      for (int lane = 0; lane < kLanes; ++lane) {
        const auto in = [&](size_t i) { return value_at(inputs, form["inputs"][i], base + size_t(lane)); };
        if (is_ours_to_choose(name, form["inputs"].size() > 1 ? in(1) : 1)) continue;
        const uint64_t expected = value_at(outputs, form["outputs"][0], base + size_t(lane));
        const uint64_t got = w.get(row.operands.kind[0], inst.operand[0], lane);
        if (got == expected || wrong++) continue;
        char text[128];
        std::snprintf(text, sizeof text, "(%llx, %llx) gave %llx, recorded %llx",
                      static_cast<unsigned long long>(in(0)),
                      static_cast<unsigned long long>(form["inputs"].size() > 1 ? in(1) : 0),
                      static_cast<unsigned long long>(got), static_cast<unsigned long long>(expected));
        first = text;
      }
    }
    INFO(name << ": " << first);
    CHECK(wrong == 0);
  }
  CHECK(compared.size() >= 80);  // the forms that both have: names match PTX's
}
