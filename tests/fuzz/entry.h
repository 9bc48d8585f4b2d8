// Declares what the fuzzers do with one input. The replay test calls the same functions.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "isa/program.h"

namespace glint::fuzz {

// Names the step that an input reached.
enum class Reached : uint8_t { Refused, Parsed, Verified, Ran };

// Takes text. A program that parses must survive being written and parsed again. A program that the verifier
// accepts must run without a crash and without a fault of control flow. Panics (base/check.h) when that does
// not hold.
Reached assembly(const std::string& text);

// Takes bytes that spell a program of the op table, often one that text cannot write.
Reached program(std::span<const uint8_t> bytes);
isa::Program program_of(std::span<const uint8_t> bytes);

}  // namespace glint::fuzz
