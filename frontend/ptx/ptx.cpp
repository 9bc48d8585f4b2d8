// Implements the entry points of the PTX front end.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/ptx/ptx.h"

#include <fmt/format.h>

#include "frontend/ptx/lowering.h"

namespace glint::frontend {

std::vector<std::string> kernel_names(std::string_view text, const std::string& file) {
  std::vector<std::string> names;
  for (const ptx::Function& f : ptx::parse(text, file).functions)
    if (f.is_entry) names.push_back(f.name);
  return names;
}

namespace {

const ptx::Function& find_entry(const ptx::Module& module, const std::string& entry) {
  std::vector<std::string> names;
  const ptx::Function* found = nullptr;
  for (const ptx::Function& f : module.functions) {
    if (!f.is_entry || !f.has_body) continue;
    names.push_back(f.name);
    if (f.name == entry || entry.empty()) found = &f;
  }
  if (names.empty()) throw UserError({module.file, 0, 0}, "the module has no kernel (.entry)");
  const std::string list = fmt::format("kernels: {}", fmt::join(names, ", "));
  if (entry.empty() && names.size() > 1)
    throw UserError({module.file, 0, 0}, "the module has several kernels: name one", list);
  if (!found) throw UserError({module.file, 0, 0}, fmt::format("there is no kernel '{}'", entry), list);
  return *found;
}

}  // namespace

Kernel compile_ptx(std::string_view text, const std::string& file, const std::string& entry,
                   const PtxOptions& options) {
  const ptx::Module module = ptx::parse(text, file);
  if (module.address_size != 64)
    throw UnsupportedError(
        fmt::format("{}: error: the module has addresses of {} bits, but Glint supports only 64", file,
                    module.address_size));
  const ptx::Function& function = find_entry(module, entry);
  Kernel kernel;
  kernel.required_block = function.required_block;
  kernel.largest_block = function.largest_block;
  kernel.in_clusters = function.required_cluster.has_value();
  Diagnostics errors, unsupported;
  ptx::KernelLowering lowering(module, function, options, kernel, errors, unsupported);
  std::vector<VirtualProgram> programs = lowering.run();
  if (errors.has_errors()) {
    for (const std::string& message : unsupported.messages()) errors.error({}, message);
    errors.throw_if_errors();
  }
  if (unsupported.has_errors())
    throw UnsupportedError(fmt::format("{}", fmt::join(unsupported.messages(), "\n")));
  BackendOptions backend = options.backend;
  backend.like_an_assembler = options.shape;
  kernel.program = assemble(std::move(programs.front()), backend);
  for (size_t i = 1; i < programs.size(); ++i)
    kernel.functions.push_back(assemble(std::move(programs[i]), backend));
  kernel.program.shared_bytes = uint32_t(lowering.static_shared_bytes());
  return kernel;
}

}  // namespace glint::frontend
