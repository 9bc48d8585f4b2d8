// Trains a network with one layer of 16 hidden units by one step of back-propagation.
// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "compute/programs/programs.h"

namespace glint::compute {
namespace {

constexpr uint32_t kHidden = 16, kWidth = kHidden + 1;
constexpr float kRate = 0.3f, kMomentum = 0.3f;

using Floats = std::vector<float>;

// Returns the sums of 16 inputs each, in the order of a tree.
Floats forward(const Floats& inputs, const Floats& weights, uint32_t count) {
  Floats out;
  for (uint32_t block = 0; block < count / 16; ++block)
    for (uint32_t unit = 1; unit <= kHidden; ++unit) {
      float products[16];
      for (uint32_t i = 0; i < 16; ++i) {
        const uint32_t input = block * 16 + i + 1;
        products[i] = weights[input * kWidth + unit] * inputs[input];
      }
      for (uint32_t reach = 1; reach < 16; reach *= 2)
        for (uint32_t i = 0; i < 16; i += 2 * reach) products[i] += products[i + reach];
      out.push_back(products[0]);
    }
  return out;
}

void adjust(const Floats& inputs, const Floats& errors, Floats& weights, Floats& changes) {
  for (uint32_t input = 0; input < inputs.size(); ++input)
    for (uint32_t unit = 1; unit <= kHidden; ++unit) {
      const uint32_t i = input * kWidth + unit;
      const float step = input == 0 ? kRate * errors[unit] : kRate * errors[unit] * inputs[input];
      changes[i] = step + kMomentum * changes[i];
      weights[i] += changes[i];
    }
}

float squashed(float value) {
  return 1.0f / (1.0f + std::exp(-value));
}

// Returns the errors of the hidden units for one output unit whose target is 0.1.
Floats errors_of(std::span<const float> sums, const Floats& weights, const Floats& output_weights) {
  float hidden[kWidth] = {1}, out = output_weights[0];
  for (uint32_t unit = 1; unit <= kHidden; ++unit) {
    float sum = weights[unit];
    for (size_t i = unit - 1; i < sums.size(); i += kHidden) sum += sums[i];
    hidden[unit] = squashed(sum);
    out += output_weights[unit] * hidden[unit];
  }
  out = squashed(out);
  const float output_error = out * (1 - out) * (0.1f - out);
  Floats errors(kWidth);
  for (uint32_t unit = 1; unit <= kHidden; ++unit)
    errors[unit] = hidden[unit] * (1 - hidden[unit]) * output_error * output_weights[unit];
  return errors;
}

}  // namespace

void backprop(Host& host, Size size) {
  const uint32_t count = size == Size::Full ? 65'536 : 4'096;
  const Floats inputs = host.random.floats(count + 1, 0, 1),
               output_weights = host.random.floats(kWidth, -1, 1);
  // The weights are small, so that no hidden unit is saturated.
  Floats weights = host.random.floats(inputs.size() * kWidth, -0.01f, 0.01f), changes(weights.size());
  const auto values = host.buffer("inputs", inputs), matrix = host.buffer("weights", weights),
             sums = host.buffer<float>("sums", count / 16 * kHidden), moved = host.buffer("changes", changes);
  const std::array<uint32_t, 3> groups{count / 16, 1, 1};
  host.launch("backprop_forward", groups, {values, matrix, sums}, kHidden);
  host.check("sums", sums, forward(inputs, weights, count));
  const Floats errors = errors_of(host.view(sums), weights, output_weights);
  host.launch("backprop_adjust", groups, {values, matrix, moved, host.buffer("errors", errors)}, kHidden);
  adjust(inputs, errors, weights, changes);
  host.check("weights", matrix, weights);
  host.check("changes", moved, changes);
}

}  // namespace glint::compute
