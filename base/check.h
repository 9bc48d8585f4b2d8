// Declares the checks for Glint's own mistakes. They are always on, print both values and abort. User input
// is never tested with them.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <string>

namespace glint {

[[noreturn]] void check_failed(const char* file, int line, const std::string& what);

}  // namespace glint

#define GLINT_PANIC(...) ::glint::check_failed(__FILE__, __LINE__, fmt::format(__VA_ARGS__))
#define GLINT_CHECK(condition, ...)                                                                       \
  do {                                                                                                    \
    if (!(condition)) [[unlikely]]                                                                        \
      ::glint::check_failed(__FILE__, __LINE__, std::string(#condition ": ") + fmt::format(__VA_ARGS__)); \
  } while (0)
#define GLINT_CHECK_COMPARE(a, op, b)                                                               \
  do {                                                                                              \
    const auto glint_a = (a);                                                                       \
    const auto glint_b = (b);                                                                       \
    if (!(glint_a op glint_b)) [[unlikely]]                                                         \
      ::glint::check_failed(__FILE__, __LINE__,                                                     \
                            fmt::format("{} {} {}: {} against {}", #a, #op, #b, glint_a, glint_b)); \
  } while (0)
#define GLINT_CHECK_EQ(a, b) GLINT_CHECK_COMPARE(a, ==, b)
#define GLINT_CHECK_LE(a, b) GLINT_CHECK_COMPARE(a, <=, b)
#ifdef GLINT_DCHECKS
#define GLINT_DCHECK(condition, ...) GLINT_CHECK(condition, __VA_ARGS__)
#else
#define GLINT_DCHECK(condition, ...) \
  do {                               \
  } while (0)
#endif
