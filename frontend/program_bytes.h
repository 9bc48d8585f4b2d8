// Lists the fields of a program in the order in which the cache keeps them (base/byte_stream.h).
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "base/byte_stream.h"
#include "isa/program.h"

namespace glint::isa {

template <class Visit>
void for_each_field(Scope& scope, const Visit& visit) {
  visit(scope.function);
  visit(scope.caller);
  visit(scope.call);
}
template <class Visit>
void for_each_field(SpirvLine& line, const Visit& visit) {
  visit(line.text);
  visit(line.line);
}
template <class Visit>
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
  visit(p.function);
  visit(p.payload_bytes);
  visit(p.attribute_bytes);
  visit(p.local_size);
  visit(p.shared_bytes);
  visit(p.messages);
  visit(p.scopes);
  visit(p.spirv);
}

}  // namespace glint::isa
