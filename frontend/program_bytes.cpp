// Lists the fields of a program in the order in which they are stored.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/program_bytes.h"

namespace glint::frontend {
namespace {

// Visits all fields of a program that is written or read.
template <class Program, class Visit>
void for_each_field(Program& p, const Visit& visit) {
  visit(p.name);
  visit(p.stage);
  visit(p.code);
  visit(p.constants);
  visit(p.files);
  visit(p.lines);
  visit(p.labels);
  visit(p.num_registers);
  visit(p.local_bytes);
  visit(p.payload_bytes);
  visit(p.attribute_bytes);
  visit(p.local_size);
  visit(p.shared_bytes);
  visit(p.messages);
  visit(p.scopes);
  visit(p.spirv);
}

}  // namespace

void put_program(ByteWriter& out, const isa::Program& program) {
  for_each_field(program, [&](const auto& field) { out.put(field); });
}

isa::Program get_program(ByteReader& in) {
  isa::Program program;
  for_each_field(program, [&](auto& field) { in.get(field); });
  return program;
}

}  // namespace glint::frontend
