// Holds PTX forms with the inputs and outputs that a GPU has recorded, and runs them on Glint.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "isa/paths.h"
#include "pipeline/kernel_launch.h"

namespace glint::golden {

struct Array {
  std::string type;    // f32, u16, pred ...
  uint32_t bytes = 0;  // per lane
  size_t offset = 0;   // in the recording's inputs or outputs
};

// Holds one form: a text with the operands A, B, C, E (inputs), D0, D1 (outputs), TMP and SHM (8 bytes of
// global and of shared memory per lane) and PP (a predicate).
struct Form {
  std::string op, text;
  std::vector<Array> inputs, outputs;
};

struct Recording {
  uint32_t lanes = 0;  // a multiple of 32
  std::string inputs, outputs;
  std::vector<Form> forms;

  uint64_t input(const Form& form, size_t operand, uint32_t lane) const {
    return value(inputs, form.inputs[operand], lane);
  }
  uint64_t output(const Form& form, size_t operand, uint32_t lane) const {
    return value(outputs, form.outputs[operand], lane);
  }
  static uint64_t value(const std::string& data, const Array& array, uint32_t lane);
};

// Returns the contents of a file, or of its compressed form if only that is present.
std::string contents(const std::filesystem::path& path);

// Reads a folder with manifest.json, inputs.bin and outputs.bin, which may be compressed as .zst.
Recording load_folder(const std::filesystem::path& folder);
// Reads the extract made by tools/make_golden_extract.py: forms.txt and lanes.bin.
Recording load_extract(const std::filesystem::path& folder);

// Returns a whole module with the form as a kernel.
std::string kernel_text(const Form& form);

// Lets the kernel run with the handlers of one SIMD path.
void use_path(pipeline::KernelWorld& world, isa::Path path);

// Holds the outputs of all lanes by each path, [path][operand][lane], or the message when the form does not
// compile.
struct Outcome {
  std::string refused;
  std::vector<isa::Path> paths;
  std::vector<std::vector<std::vector<uint64_t>>> outputs;
};
Outcome run(const Recording& recording, const Form& form);

}  // namespace glint::golden
