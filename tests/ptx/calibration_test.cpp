// Runs fourteen kernels as nvcc compiled them, on the inputs of the program that ran them on a GPU, and
// expects the same outputs.
// SPDX-License-Identifier: Apache-2.0
//
// The data lie next to the repository: valid.ptx, valid_out.bin.zst and valid_out.txt, which lists the
// outputs.
#include "tests/ptx/calibration.h"

#include <cstdio>
#include <filesystem>
#include <functional>

#include "tests/ptx/launcher.h"
#include "tests/support/catch.h"

using namespace glint;

namespace {

class Calibration {
 public:
  explicit Calibration(const std::filesystem::path& folder)
      : recorded(folder), text_((read_file(folder / "valid.ptx"))) {}

  Launcher kernel(const std::string& name) const { return Launcher(text_, "valid.ptx", name); }
  void compare(const std::string& name, const std::vector<uint32_t>& got, const std::string& output) {
    const std::vector<uint32_t> expected = recorded.get<uint32_t>(output);
    REQUIRE(got.size() == expected.size());
    size_t different = 0, first = 0;
    for (size_t i = 0; i < got.size(); ++i)
      if (got[i] != expected[i] && different++ == 0) first = i;
    if (different)
      std::printf("%-28s %zu of %zu words differ, first %zu: recorded %08x, got %08x\n", name.c_str(),
                  different, got.size(), first, expected[first], got[first]);
    INFO(name << " (" << output << ")");
    CHECK(different == 0);
  }

  const Inputs in;
  const Outputs recorded;

 private:
  const std::string text_;
};

using Words = std::vector<uint32_t>;

void compare_rays(Calibration& c) {
  const Words nodes = c.recorded.get<uint32_t>("bvh nodes"), triangles = c.recorded.get<uint32_t>("tris");
  const uint32_t rays = 128 * 128;
  const pipeline::KernelGrid grid{{rays / 128, 1, 1}, {128, 1, 1}, 0};
  const Words primary = c.recorded.get<uint32_t>("rays primary"),
              random = c.recorded.get<uint32_t>("rays random");
  Launcher brute = c.kernel("k_brute");
  brute.buffer(triangles)
      .value(512u)
      .buffer(primary)
      .buffer(Words(rays * 4))
      .value(rays)
      .run_functional(grid);
  c.compare("k_brute", brute.read<uint32_t>(2, rays * 4), "k_brute");
  for (const bool is_random : {false, true}) {
    Launcher bvh = c.kernel("k_bvh");
    bvh.buffer(nodes)
        .buffer(triangles)
        .buffer(is_random ? random : primary)
        .buffer(Words(rays * 4))
        .buffer(Words(rays))
        .value(rays);
    bvh.run_functional(grid);
    const std::string name = is_random ? "k_bvh random rays" : "k_bvh primary rays";
    c.compare(name, bvh.read<uint32_t>(3, rays * 4), name + (" 4096"));
    c.compare(name + " steps", bvh.read<uint32_t>(4, rays), name + ": node");
  }
}

}  // namespace

TEST_CASE("the calibration kernels give the outputs that a GPU gave") {
  const auto folder = std::filesystem::path(GLINT_SOURCE_DIR) / "../shared/data/h200/kernels";
  if (!std::filesystem::exists(folder / "valid.ptx")) {
    WARN("SKIPPED: no calibration kernels in " << folder.string());
    return;
  }
  Calibration c(folder);
  const uint32_t n = Inputs::kCount;
  const pipeline::KernelGrid lines{{n / 256, 1, 1}, {256, 1, 1}, 0}, tiles{{16, 16, 1}, {16, 16, 1}, 0},
      turns{{16, 16, 1}, {32, 8, 1}, 0};
  const Words zeros(n);
  const auto one = [&](const std::string& name, const pipeline::KernelGrid& grid, size_t output, size_t count,
                       const std::function<void(Launcher&)>& arguments) {
    Launcher kernel = c.kernel(name);
    arguments(kernel);
    kernel.run_functional(grid);
    c.compare(name, kernel.read<uint32_t>(output, count), name + " ");
  };
  one("k_vecadd", lines, 2, n, [&](Launcher& k) { k.buffer(c.in.a).buffer(c.in.b).buffer(c.in.b).value(n); });
  one("k_saxpy_stride", lines, 1, n,
      [&](Launcher& k) { k.buffer(c.in.a).buffer(c.in.b).value(2.0f).value(n).value(8u); });
  for (const char* name : {"k_matmul", "k_matmul_tiled"})
    one(name, tiles, 2, 256 * 256,
        [&](Launcher& k) { k.buffer(c.in.a).buffer(c.in.b).buffer(c.in.b).value(256u); });
  one("k_reduce", lines, 1, 1024, [&](Launcher& k) { k.buffer(c.in.a).buffer(c.in.b).value(n); });
  for (const char* name : {"k_transpose", "k_transpose_tiled", "k_transpose_conflict"})
    one(name, turns, 1, n, [&](Launcher& k) { k.buffer(c.in.a).buffer(zeros).value(512u); });
  one("k_hist", {{64, 1, 1}, {256, 1, 1}, 0}, 1, 256,
      [&](Launcher& k) { k.buffer(c.in.u).buffer(Words(256)).value(n); });
  one("k_mandel", tiles, 0, 65536, [&](Launcher& k) { k.buffer(zeros).value(256u).value(256u).value(256u); });
  one("k_gather", lines, 2, n,
      [&](Launcher& k) { k.buffer(c.in.table).buffer(c.in.index).buffer(zeros).value(n); });
  one("k_stencil", {{16, 64, 1}, {32, 8, 1}, 0}, 1, n,
      [&](Launcher& k) { k.buffer(c.in.a).buffer(zeros).value(512u); });
  compare_rays(c);
}
