// Measures how long the handler of every value op takes for a warp, on every SIMD path of this machine, and
// prints the slowest first.
// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "isa/op_row.h"
#include "isa/paths.h"

using namespace glint;
using namespace glint::isa;

namespace {

constexpr double kLimit = 25.0;  // ns per warp on the widest path: the aim for every op that is not exempt
constexpr int kRows = 64;        // rows of each bank

// Holds operands of moderate size and some extremes. Handlers without branches take as long for either; the
// others should show it.
class Registers {
 public:
  Registers() {
    for (size_t bank = 0; bank < 3; ++bank) warp.bank[bank] = &lanes_[bank * kRows].at[0];
    uint64_t state = 0x9e37'79b9'7f4a'7c15ull;
    for (Lanes& row : lanes_)
      for (uint32_t& word : row.at) {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        const uint32_t r = uint32_t(state >> 33);
        word = r % 16 == 0 ? 0x7f80'0000 : 0x3f00'0000 + r % 0x0200'0000;
      }
    warp.predicate.fill(0x5a5a'5a5a);
    warp.exec = kAllLanes;
  }
  // Lets ops whose lanes read each other take all lanes. Their last source is the mask.
  void fill_members(const OpRow& row, const Inst& inst) {
    if (row.unit != Unit::Shuffle || row.operands.count < 3) return;
    int slots = 0;
    for (const OperandKind kind : row.operands.view()) slots += slots_of(kind);
    std::fill_n(warp.write(inst.operand[size_t(slots - 1)]), kLanes, ~0u);
  }
  Warp warp;

 private:
  struct alignas(64) Lanes {
    uint32_t at[kLanes];
  };
  std::vector<Lanes> lanes_ = std::vector<Lanes>(3 * kRows);
};

// Returns an instruction whose destinations lie apart from its sources, so that the sources stay as they are.
Inst inst_of(const OpRow& row) {
  Inst inst;
  int slot = 0;
  // The slots are not 4 KiB apart, because loads wait for earlier stores at the same offset.
  Slot source = 0, destination = 44, predicate = 0;
  for (const OperandKind kind : row.operands.view())
    for (const int end = slot + slots_of(kind); slot < end; ++slot) {
      const bool is_predicate = kind == OperandKind::DstPred || kind == OperandKind::SrcPred;
      Slot& next = is_predicate ? predicate : is_destination(kind) ? destination : source;
      inst.operand[size_t(slot)] = next;
      next = Slot(next + (is_predicate ? 1 : 2));
    }
  return inst;
}

// Returns the best time of several runs, because other work on the machine only adds to it.
double nanoseconds(const OpRow& row, Registers& registers) {
  const Inst inst = inst_of(row);
  registers.fill_members(row, inst);
  Warp& warp = registers.warp;
  double best = 1e9;
  int calls = 64;
  for (int run = 0; run < 12; ++run) {
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < calls; ++i) row.run(warp, inst, row);
    const double ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    best = std::min(best, ns / calls);
    calls = std::clamp(int(20'000 / (ns / calls + 0.1)), 16, 4096);  // 20 microseconds a run
  }
  return best;
}

bool is_exempt(const OpRow& row) {
  const bool is_conversion = row.name.starts_with("cvt.");
  return row.unit == Unit::Fp64Div || (row.unit == Unit::Sfu && !is_conversion) ||
         row.name.find("sqrt") != std::string_view::npos;
}

struct Measured {
  size_t op;
  std::vector<double> ns;  // one for each path
};

struct Options {
  std::string filter;
  size_t head = 0;
  bool slow = false;
};

std::vector<Path> paths() {
  std::vector<Path> out;
  for (int p = 0; p < int(Path::Count); ++p)
    if (is_supported(Path(p))) out.push_back(Path(p));
  return out;
}

std::vector<Measured> measure(const Options& options) {
  Registers registers;
  std::vector<Measured> out;
  for (size_t op = 0; op < op_table().size(); ++op) {
    const OpRow& row = op_table()[op];
    if (row.effect != Effect::None || row.name.find(options.filter) == std::string_view::npos) continue;
    Measured m{op, {}};
    for (const Path path : paths()) m.ns.push_back(nanoseconds(op_table(path)[op], registers));
    out.push_back(m);
  }
  // Processors run slower for seconds at a time. So what looks slow is measured again, after all others.
  for (int again = 0; again < 3; ++again)
    for (Measured& m : out)
      if (m.ns.back() > kLimit)
        m.ns.back() = std::min(m.ns.back(), nanoseconds(op_table(paths().back())[m.op], registers));
  std::stable_sort(out.begin(), out.end(),
                   [](const Measured& a, const Measured& b) { return a.ns.back() > b.ns.back(); });
  return out;
}

void print(const std::vector<Measured>& all, const Options& options) {
  fmt::print("{:<36} {:<10}", "ns a warp, all lanes active", "unit");
  for (const Path path : paths()) fmt::print(" {:>9}", name_of(path));
  fmt::print("\n");
  size_t shown = 0, slow = 0;
  for (const Measured& m : all) {
    const OpRow& row = op_table()[m.op];
    const bool is_slow = m.ns.back() > kLimit && !is_exempt(row);
    slow += is_slow;
    if ((options.slow && !is_slow) || (options.head && shown >= options.head)) continue;
    ++shown;
    fmt::print("{:<36} {:<10}", row.name, name_of(row.unit));
    for (const double ns : m.ns) fmt::print(" {:>9.1f}", ns);
    fmt::print("{}\n", is_slow ? "  over the limit" : m.ns.back() > kLimit ? "  exempt" : "");
  }
  fmt::print("{} ops, {} over {} ns on {} (exempt: double-precision division, roots, special functions)\n",
             all.size(), slow, kLimit, name_of(paths().back()));
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app("Times the handler of every value op.", "isa_bench");
  app.add_option("--filter", options.filter, "Only ops whose names contain this");
  app.add_option("--head", options.head, "Print so many lines of the table (default: all)");
  app.add_flag("--slow", options.slow, "Print only what is over the limit");
  CLI11_PARSE(app, argc, argv);
  print(measure(options), options);
  return 0;
}
