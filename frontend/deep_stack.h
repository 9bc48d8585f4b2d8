// Runs work on a thread whose stack is deep enough for compilers that recurse over long expressions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <utility>

namespace glint::frontend {

// Runs `work` to its end on a thread of its own, and passes its exception on. The stack has 1 GB of
// addresses, of which only the touched pages become memory. Where the system refuses so much, it has as much
// as the system gives, and throws an Error when that is nothing.
//
// glslang and SPIRV-Tools recurse once for each operand of a long sum, and an ordinary stack of 8 MB ends
// after 12,000 of them. One operand takes up to 700 bytes of stack, so kMostTokens (glsl/token_count.h)
// bounds what a source can use.
void on_deep_stack(const std::function<void()>& work);

// Does the same for work that returns a value.
template <class Work>
auto with_deep_stack(Work&& work) {
  std::optional<decltype(work())> result;
  on_deep_stack([&] { result.emplace(work()); });
  return std::move(*result);
}

}  // namespace glint::frontend
