// Declares the steps of reading a description, one for each family of tables.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "pipeline/description/description.h"

namespace glint::pipeline {

struct Reading {
  PipelineDescription& out;
  Diagnostics& errors;
  frontend::GlslOptions glsl{};  // of shader files without a table of their own, once [compile] is read
  std::string beside(const std::string& file) const;  // relative paths start at the description's folder
};

// These are in read_shaders.cpp.
void read_shaders(Reading& r, TableReader& root);
RecordDescription read_raygen(Reading& r, const Value& value);
// Adds the file of a shader that has no table of its own.
void add_shader_file(Reading& r, const std::string& name, const SourceLocation& where);
// This is in read_launches.cpp.
void read_launches(Reading& r, TableReader& root);
// These are in read_resources.cpp.
void read_resources(Reading& r, TableReader& root);
// Reads an [[image]] of a launch file of kernels. It needs a name, because arguments name it.
KernelImage read_kernel_image(Reading& r, const Value& value);
DataSource read_data(Reading& r, TableReader& t, bool is_buffer);
// These are in read_structures.cpp.
void read_structures(Reading& r, TableReader& root);
Slot read_slot(TableReader& t);

}  // namespace glint::pipeline
