// Compares instructions and cycles of the calibration kernels on the presets `h200` and `h100` with a GPU's
// counters.
// SPDX-License-Identifier: Apache-2.0
//
// The kernels, their inputs and the counters of an H200 lie next to the repository, and those of an H100 in
// bench/calibration. `test_ptx_h200 [rays]` runs the kernels that take long.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/config.h"
#include "base/diagnostics.h"
#include "pipeline/params.h"
#include "pipeline/run_stats.h"
#include "tests/ptx/calibration.h"
#include "tests/ptx/launcher.h"

using namespace glint;

namespace {

using Words = std::vector<uint32_t>;

struct Counters {
  double cycles = 0, instructions = 0, global_loads = 0;
};

// Returns the counters by name of the launch. Each has those of its middle run by cycles.
std::map<std::string, Counters> read_counters(const std::filesystem::path& path) {
  std::map<std::string, std::vector<Counters>> launches;
  std::istringstream lines(read_file(path));
  std::vector<std::string> head;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> cells;
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (head.empty()) {
      head = cells;
      continue;
    }
    const auto number = [&](const char* name) {
      for (size_t i = 0; i < head.size() && i < cells.size(); ++i)
        if (head[i] == name) return std::atof(cells[i].c_str());
      FAIL("no column " << name);
      return 0.0;
    };
    launches[cells.at(0)].push_back({number("sm__cycles_elapsed.max"), number("smsp__inst_executed.sum"),
                                     number("l1tex__t_requests_pipe_lsu_mem_global_op_ld.sum")});
  }
  std::map<std::string, Counters> out;
  for (auto& [name, all] : launches) {
    const auto middle = all.begin() + std::ptrdiff_t(all.size() / 2);
    std::nth_element(all.begin(), middle, all.end(),
                     [](const Counters& a, const Counters& b) { return a.cycles < b.cycles; });
    out[name] = *middle;
  }
  return out;
}

// Returns the parameters of `h200`, or of a preset whose base it is.
pipeline::GpuParams params_of(const std::string& preset) {
  Config config;
  const std::string folder = std::string(GLINT_SOURCE_DIR) + "/configs/";
  config.add_file(folder + "h200.toml");
  if (preset != "h200") config.add_file(folder + preset + ".toml");
  Diagnostics diagnostics;
  ConfigTable root = config.root(diagnostics);
  root.take_string("base", "");
  pipeline::GpuParams params;
  read_params(root, params);
  diagnostics.throw_if_errors();
  return params;
}

class Runs {
 public:
  Runs(const std::filesystem::path& folder, const std::string& preset, const std::filesystem::path& counters)
      : recorded(folder),
        text_(read_file(folder / "valid.ptx")),
        counters_(read_counters(counters)),
        gpu_(params_of(preset)) {}

  template <class Arguments>
  void run(const std::string& name, const pipeline::KernelGrid& grid, const Arguments& arguments,
           const std::string& launch = {}) {
    Launcher kernel(text_, "valid.ptx", name, pipeline::ptx_options(gpu_.compiler));
    arguments(kernel);
    kernel.world().set_grid(grid);
    kernel.set_arguments();
    pipeline::TimingMachine machine(gpu_, kernel.world().world, false);
    const double cycles = double(machine.run({}));
    double instructions = 0, global_loads = 0;
    for (uint32_t i = 0; i < machine.num_cores(); ++i) {
      const core::CoreStats& stats = machine.core(i).stats();
      instructions += double(stats.instructions.value() + stats.sequence_slots.value());
      global_loads += double(stats.global_loads.value());
    }
    const Counters& real = counters_.at(launch.empty() ? name : launch);
    const double error = cycles / real.cycles - 1;
    std::printf("%-22s cycles %8.0f of %8.0f %+6.1f %%   instructions %9.0f of %9.0f %+6.1f %%\n",
                (launch.empty() ? name : launch).c_str(), cycles, real.cycles, 100 * error, instructions,
                real.instructions, 100 * (instructions / real.instructions - 1));
    std::fflush(stdout);
    INFO(name);
    CHECK(std::abs(instructions / real.instructions - 1) <= 0.05);
    CHECK(global_loads == real.global_loads);  // loads by warps: lanes diverged and met at the same places
    sum_ += std::abs(error);
    ++count_;
  }
  double mean_error() const { return sum_ / count_; }

  const Inputs in;
  const Outputs recorded;

 private:
  const std::string text_;
  const std::map<std::string, Counters> counters_;
  const pipeline::GpuParams gpu_;
  double sum_ = 0;
  int count_ = 0;
};

std::filesystem::path folder() {
  return std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/h200/kernels";
}

// Names the cards that ran the kernels: a preset and the file of its counters.
struct Card {
  const char* preset;
  std::filesystem::path counters;
};
std::vector<Card> cards() {
  const auto recorded = std::filesystem::path(GLINT_SOURCE_DIR) / "bench/calibration";
  return {{"h200", recorded / "counters_h200.csv"}, {"h100", recorded / "counters_h100.csv"}};
}

void run_short(const Card& card) {
  std::printf("%s\n", card.preset);
  Runs runs(folder(), card.preset, card.counters);
  const uint32_t n = Inputs::kCount;
  const pipeline::KernelGrid lines{{n / 256, 1, 1}, {256, 1, 1}, 0}, tiles{{16, 16, 1}, {16, 16, 1}, 0},
      turns{{16, 16, 1}, {32, 8, 1}, 0};
  const Words zeros(n);
  const auto& in = runs.in;
  runs.run("k_vecadd", lines, [&](Launcher& k) { k.buffer(in.a).buffer(in.b).buffer(in.b).value(n); });
  runs.run("k_saxpy_stride", lines,
           [&](Launcher& k) { k.buffer(in.a).buffer(in.b).value(2.0f).value(n).value(8u); });
  for (const char* name : {"k_matmul", "k_matmul_tiled"})
    runs.run(name, tiles, [&](Launcher& k) { k.buffer(in.a).buffer(in.b).buffer(in.b).value(256u); });
  runs.run("k_reduce", lines, [&](Launcher& k) { k.buffer(in.a).buffer(in.b).value(n); });
  for (const char* name : {"k_transpose", "k_transpose_tiled", "k_transpose_conflict"})
    runs.run(name, turns, [&](Launcher& k) { k.buffer(in.a).buffer(zeros).value(512u); });
  runs.run("k_hist", {{64, 1, 1}, {256, 1, 1}, 0},
           [&](Launcher& k) { k.buffer(in.u).buffer(Words(256)).value(n); });
  runs.run("k_mandel", tiles, [&](Launcher& k) { k.buffer(zeros).value(256u).value(256u).value(256u); });
  runs.run("k_gather", lines,
           [&](Launcher& k) { k.buffer(in.table).buffer(in.index).buffer(zeros).value(n); });
  runs.run("k_stencil", {{16, 64, 1}, {32, 8, 1}, 0},
           [&](Launcher& k) { k.buffer(in.a).buffer(zeros).value(512u); });
  std::printf("mean absolute error of cycles: %.1f %%\n", 100 * runs.mean_error());
  CHECK(runs.mean_error() <= 0.20);
}

void run_rays(const Card& card) {
  std::printf("%s\n", card.preset);
  Runs runs(folder(), card.preset, card.counters);
  const Words nodes = runs.recorded.get<uint32_t>("bvh nodes"),
              triangles = runs.recorded.get<uint32_t>("tris");
  const uint32_t rays = 128 * 128;
  const pipeline::KernelGrid grid{{rays / 128, 1, 1}, {128, 1, 1}, 0};
  const Words primary = runs.recorded.get<uint32_t>("rays primary"),
              random = runs.recorded.get<uint32_t>("rays random");
  runs.run("k_brute", grid, [&](Launcher& k) {
    k.buffer(triangles).value(512u).buffer(primary).buffer(Words(rays * 4)).value(rays);
  });
  for (const bool is_random : {false, true})
    runs.run(
        "k_bvh", grid,
        [&](Launcher& k) {
          k.buffer(nodes)
              .buffer(triangles)
              .buffer(is_random ? random : primary)
              .buffer(Words(rays * 4))
              .buffer(Words(rays))
              .value(rays);
        },
        is_random ? "k_bvh again" : "k_bvh");
  std::printf("mean absolute error of cycles: %.1f %%\n", 100 * runs.mean_error());
  CHECK(runs.mean_error() <= 0.20);
}

}  // namespace

TEST_CASE(
    "the short calibration kernels take the cycles that a GPU took, on average within the bound of "
    "docs/validation.md") {
  if (!std::filesystem::exists(folder() / "valid.ptx")) {
    WARN("SKIPPED: no calibration kernels in " << folder().string());
    return;
  }
  for (const Card& card : cards()) run_short(card);
}

TEST_CASE("the kernels that trace rays take the cycles that a GPU took", "[.][rays]") {
  for (const Card& card : cards()) run_rays(card);
}
