// Transforms numbers with VkFFT, which makes its GLSL at run time and compiles it with a glslang of its own,
// and prints for every size how far they are from the transform's definition, and from where they were after
// the way back.
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/vulkan/client.h"

// VkFFT 1.2 writes down the limits of an older glslang, which had fewer of them. The installed one has its
// own.
#include <glslang/Include/glslang_c_interface.h>
#include <glslang/Public/resource_limits_c.h>
struct OlderGlslangLimits {
  int numbers[93];
  int of_loops[9];
  const glslang_resource_t* operator&() const { return glslang_default_resource(); }
};
#define glslang_resource_t OlderGlslangLimits
#include <vkFFT.h>
#undef glslang_resource_t

using Complex = std::complex<float>;

namespace {

void require(VkFFTResult result, const std::string& call) {
  if (result != VKFFT_SUCCESS) throw std::runtime_error(call + " returned " + std::to_string(result));
}

std::vector<Complex> definition(const std::vector<Complex>& in) {
  std::vector<Complex> out(in.size());
  for (size_t k = 0; k < in.size(); ++k) {
    std::complex<double> sum = 0;
    for (size_t n = 0; n < in.size(); ++n)
      sum += std::complex<double>(in[n]) *
             std::polar(1.0, -2 * std::numbers::pi * double(k * n % in.size()) / double(in.size()));
    out[k] = Complex(sum);
  }
  return out;
}

float largest_difference(const Complex* a, const std::vector<Complex>& b) {
  float out = 0;
  for (size_t i = 0; i < b.size(); ++i) out = std::max(out, std::abs(a[i] - b[i]));
  return out;
}

// Prints the errors of a transform of `size` numbers and of the way back.
void transform(uint64_t size) {
  glint::test::Client client;
  const auto buffer = client.buffer(size * sizeof(Complex));
  std::vector<Complex> in;
  for (uint64_t i = 0; i < size; ++i)
    in.emplace_back(float(i * 37 % 101) / 101 - 0.5f, float(i * 53 % 97) / 97 - 0.5f);
  auto* data = static_cast<Complex*>(buffer.data);
  std::copy(in.begin(), in.end(), data);

  VkFFTConfiguration how{};
  VkFence fence = client.fence();
  uint64_t bytes = buffer.bytes;
  VkBuffer handle = buffer.buffer;
  how.FFTdim = 1, how.size[0] = size, how.normalize = 1;
  how.physicalDevice = &client.physical, how.device = &client.device, how.queue = &client.queue;
  how.commandPool = &client.pool, how.fence = &fence;
  how.buffer = &handle, how.bufferSize = &bytes;
  VkFFTApplication plan{};
  require(initializeVkFFT(&plan, how), "initializeVkFFT");
  const auto run = [&](int direction) {
    glint::test::check(client.run([&](VkCommandBuffer commands) {
      VkFFTLaunchParams launch{};
      launch.commandBuffer = &commands;
      require(VkFFTAppend(&plan, direction, &launch), "VkFFTAppend");
    }),
                       "run");
  };
  run(-1);
  const float forward = largest_difference(data, definition(in));
  run(1);
  std::printf("%llu %g %g\n", static_cast<unsigned long long>(size), forward, largest_difference(data, in));
  deleteVkFFT(&plan);
}

}  // namespace

int main() {
  try {
    for (const uint64_t size : {8, 64, 100, 243, 1001, 1024}) transform(size);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
