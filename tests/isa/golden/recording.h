// PTX forms with inputs and outputs that a GPU has recorded, and their run on Glint.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "isa/paths.h"

namespace glint::golden {

struct Array {
  std::string type;    // f32, u16, pred ...
  uint32_t bytes = 0;  // a lane
  size_t offset = 0;   // in the recording's inputs or outputs
};

// One form: text with operands A, B, C, E (inputs), D0, D1 (outputs), TMP and SHM (8 bytes of global and of
// shared memory a lane), PP (a predicate).
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

// A folder with manifest.json and, plain or as .zst, inputs.bin and outputs.bin.
Recording load_folder(const std::filesystem::path& folder);
// The extract that tools/make_golden_extract.py has made: forms.txt, lanes.bin.
Recording load_extract(const std::filesystem::path& folder);

// The form as a kernel of a whole module.
std::string kernel_text(const Form& form);

// Outputs of all lanes by each path, [path][operand][lane]; or, when the form does not compile, the message.
struct Outcome {
  std::string refused;
  std::vector<isa::Path> paths;
  std::vector<std::vector<std::vector<uint64_t>>> outputs;
};
Outcome run(const Recording& recording, const Form& form);

}  // namespace glint::golden
