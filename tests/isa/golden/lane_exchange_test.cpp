// Ops whose lanes read each other, and atomics, compared with recordings of a GPU, where they are at hand.
// SPDX-License-Identifier: Apache-2.0
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <zstd.h>

#include "isa/paths.h"
#include "tests/isa/warp_fixture.h"
#include "tests/support/catch.h"

using namespace glint;
using namespace glint::isa;

namespace {

constexpr uint32_t kUntouched = 0xcccc'cccc;  // what the recording left in lanes that did not take part

std::string unpacked(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string packed{std::istreambuf_iterator<char>(in), {}};
  std::string out(ZSTD_getFrameContentSize(packed.data(), packed.size()), '\0');
  REQUIRE(ZSTD_decompress(out.data(), out.size(), packed.data(), packed.size()) == out.size());
  return out;
}

// The recorded forms by name, with their data.
class Recordings {
 public:
  Recordings() {
    const auto folder = std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/ptx-golden";
    if (!std::filesystem::exists(folder / "manifest.json")) return;
    std::ifstream file(folder / "manifest.json");
    manifest_ = nlohmann::json::parse(file);
    inputs_ = unpacked(folder / "inputs.bin.zst");
    outputs_ = unpacked(folder / "outputs.bin.zst");
  }
  bool are_here() const {
    if (manifest_.is_null()) WARN("SKIPPED: no recordings of a GPU beside the repository");
    return !manifest_.is_null();
  }
  const nlohmann::json& form(const std::string& name) const {
    for (const nlohmann::json& form : manifest_["ops"])
      if (form["op"] == name) return form;
    FAIL("no recording of " << name);
    return manifest_;
  }
  const nlohmann::json& forms() const { return manifest_["ops"]; }
  size_t lanes() const { return manifest_["lanes"]; }
  uint64_t input(const nlohmann::json& form, size_t n, size_t lane) const { return value(inputs_, form["inputs"][n], lane); }
  uint64_t output(const nlohmann::json& form, size_t n, size_t lane) const { return value(outputs_, form["outputs"][n], lane); }

 private:
  static uint64_t value(const std::string& data, const nlohmann::json& operand, size_t lane) {
    const size_t bytes = operand["bytes"];
    uint64_t out = 0;
    std::memcpy(&out, data.data() + size_t(operand["offset"]) + lane * bytes, bytes);
    return operand["type"] == "pred" ? out != 0 : out;
  }
  nlohmann::json manifest_;
  std::string inputs_, outputs_;
};

// Registers of the op's operands, and what the recording gave for them.
struct Comparison {
  const Recordings& data;
  const OpRow& row;
  const nlohmann::json& form;
  Inst inst;
  uint64_t wrong = 0;

  Comparison(const Recordings& recordings, Path path, const std::string& op, const std::string& name)
      : data(recordings), row(op_table(path)[size_t(op_index(op))]), form(recordings.form(name)), inst(spread(row, op_index(op))) {}
  int first_source() const { return int(is_destination(row.operands.kind[0])) + int(is_destination(row.operands.kind[1])); }
  void set(WarpFixture& w, int operand, int lane, uint64_t value) const {
    w.set(row.operands.kind[size_t(operand)], inst.operand[size_t(operand)], lane, value);
  }
  void compare(WarpFixture& w, int destination, size_t output, size_t base, LaneMask lanes) {
    for (int lane = 0; lane < kLanes; ++lane) {
      const uint64_t expected = data.output(form, output, base + size_t(lane));
      if (lanes >> lane & 1)
        wrong += w.get(row.operands.kind[size_t(destination)], inst.operand[size_t(destination)], lane) != expected;
      else
        wrong += expected != kUntouched;  // the recording agrees on who takes part
    }
  }
};

std::vector<Path> paths() {
  std::vector<Path> out;
  for (int p = 0; p < int(Path::Count); ++p)
    if (is_supported(Path(p))) out.push_back(Path(p));
  return out;
}

}  // namespace

TEST_CASE("shuffles, votes, matches and reductions of whole warps give the bits of a GPU") {
  const Recordings data;
  if (!data.are_here()) return;
  for (const char* const name :
       {"shfl.sync.up.b32", "shfl.sync.down.b32", "shfl.sync.bfly.b32", "shfl.sync.idx.b32", "vote.sync.all.pred",
        "vote.sync.any.pred", "vote.sync.uni.pred", "vote.sync.ballot.b32", "match.any.sync.b32", "match.all.sync.b32",
        "match.any.sync.b64", "redux.sync.add.s32", "redux.sync.add.u32", "redux.sync.min.s32", "redux.sync.min.u32",
        "redux.sync.max.s32", "redux.sync.max.u32", "redux.sync.and.b32", "redux.sync.or.b32", "redux.sync.xor.b32"})
    for (const Path path : paths()) {
      INFO(name_of(path) << " " << name);
      Comparison c(data, path, name, name);
      for (size_t base = 0; base < data.lanes(); base += kLanes) {
        WarpFixture w;
        w.warp.exec = kAllLanes;
        int operand = c.first_source();
        for (size_t i = 0; i < c.form["inputs"].size(); ++i, ++operand)
          for (int lane = 0; lane < kLanes; ++lane) c.set(w, operand, lane, data.input(c.form, i, base + size_t(lane)));
        for (int lane = 0; lane < kLanes; ++lane) c.set(w, operand, lane, kAllLanes);
        c.row.run(w.warp, c.inst);
        for (int d = 0; d < c.first_source() && size_t(d) < c.form["outputs"].size(); ++d) c.compare(w, d, size_t(d), base, kAllLanes);
      }
      CHECK(c.wrong == 0);
    }
}

TEST_CASE("only the lanes of the mask take part, as on a GPU") {
  const Recordings data;
  if (!data.are_here()) return;
  for (const auto& [op, name] : {std::pair{"redux.sync.add.u32", "redux.sync.add.u32(mask B)"},
                                 {"match.any.sync.b32", "match.any.sync.b32(mask B)"},
                                 {"vote.sync.ballot.b32", "vote.sync.ballot.b32(odd A, mask B)"},
                                 {"activemask.b32", "activemask.b32(inside mask B)"},
                                 {"elect.sync", "elect.sync(mask B)"}})
    for (const Path path : paths()) {
      INFO(name_of(path) << " " << name);
      Comparison c(data, path, op, name);
      for (size_t base = 0; base < data.lanes(); base += kLanes) {
        WarpFixture w;
        const auto mask = LaneMask(data.input(c.form, 1, base));
        w.warp.exec = mask;
        const int first = c.first_source(), last = c.row.operands.count - 1;
        for (int lane = 0; lane < kLanes; ++lane) {
          const uint64_t a = data.input(c.form, 0, base + size_t(lane));
          if (first < last) c.set(w, first, lane, c.row.operands.kind[size_t(first)] == OperandKind::SrcPred ? a & 1 : a);
          if (first <= last) c.set(w, last, lane, data.input(c.form, 1, base + size_t(lane)));
        }
        c.row.run(w.warp, c.inst);
        c.compare(w, 0, 0, base, mask);
        if (first == 2) c.compare(w, 1, 1, base, mask);
      }
      CHECK(c.wrong == 0);
    }
}

TEST_CASE("every atomic leaves and returns the bits of a GPU, in global and in shared memory") {
  const Recordings data;
  if (!data.are_here()) return;
  size_t compared = 0;
  for (const nlohmann::json& form : data.forms()) {
    const std::string name = form["op"], op = name.substr(0, name.find('('));
    if (!name.starts_with("atom.")) continue;
    REQUIRE(find_op(op) >= 0);
    ++compared;
    for (const Path path : paths()) {
      const OpRow& row = op_table(path)[size_t(find_op(op))];
      const uint64_t kept = row.memory.bytes == 8 ? ~uint64_t{0} : (uint64_t{1} << row.memory.bytes * 8) - 1;
      const bool is_swap = form["inputs"].size() == 3;
      size_t wrong = 0;
      for (size_t lane = 0; lane < data.lanes(); ++lane) {
        const uint64_t old = data.input(form, 0, lane), b = data.input(form, 1, lane);
        const uint64_t c = is_swap ? data.input(form, 2, lane) : row.memory.space == Space::Global;
        wrong += data.output(form, 0, lane) != old || data.output(form, 1, lane) != (row.atomic(old, b, c) & kept);
      }
      INFO(name_of(path) << " " << name);
      CHECK(wrong == 0);
    }
  }
  CHECK(compared >= 60);
}
