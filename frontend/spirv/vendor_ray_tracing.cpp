// Rewrites OpTraceNV, OpTraceMotionNV and OpExecuteCallableNV word by word.
// SPDX-License-Identifier: Apache-2.0
#include "frontend/spirv/vendor_ray_tracing.h"

#include <initializer_list>
#include <map>
#include <optional>
#include <spirv/unified1/spirv.hpp11>
#include <string_view>
#include <utility>

#include "frontend/spirv/words.h"

namespace glint::frontend {
namespace {

using Storage = spv::StorageClass;

class Rewriter {
 public:
  explicit Rewriter(const std::vector<uint32_t>& words) : words_(words) {}

  std::vector<uint32_t> run() {
    read_declarations();
    if (!is_vendor_) return words_;
    add_missing_variables();
    std::vector<uint32_t> out(words_.begin(), words_.begin() + kHeaderWords);
    out[kBoundWord] = bound_;
    for_each([&](spv::Op op, size_t at, size_t length) {
      if (op == spv::Op::OpFunction) declare(out);
      const size_t begin = out.size();
      out.insert(out.end(), words_.begin() + long(at), words_.begin() + long(at + length));
      const bool calls = op == spv::Op::OpExecuteCallableNV;
      if (op == spv::Op::OpEntryPoint) {
        for (const Missing& m : missing_) out.push_back(m.variable);
        out[begin] += uint32_t(missing_.size()) << 16;
      }
      if (op == spv::Op::OpCapability && words_[at + 1] == uint32_t(spv::Capability::RayTracingNV))
        append(out, spv::Op::OpCapability, {uint32_t(spv::Capability::RayTracingKHR)});
      if (op == spv::Op::OpExtension && !has_extension_) {
        // The words spell "SPV_KHR_ray_tracing".
        append(out, spv::Op::OpExtension, {0x5f56'5053, 0x5f52'484b, 0x5f79'6172, 0x6361'7274, 0x0067'6e69});
        has_extension_ = true;
      }
      if (!calls && op != spv::Op::OpTraceNV && op != spv::Op::OpTraceMotionNV) return;
      const std::optional<uint32_t> variable = find(out.back(), calls);
      if (!variable) return;  // The lowering reports it.
      out.back() = *variable;
      const spv::Op standard = calls                      ? spv::Op::OpExecuteCallableKHR
                               : op == spv::Op::OpTraceNV ? spv::Op::OpTraceRayKHR
                                                          : spv::Op::OpTraceRayMotionNV;
      out[begin] = uint32_t(length) << 16 | uint32_t(standard);
    });
    return out;
  }

 private:
  template <class Visit>
  void for_each(Visit&& visit) const {
    for (size_t at = kHeaderWords; at < words_.size() && words_[at] >> 16 != 0; at += words_[at] >> 16)
      visit(spv::Op(words_[at] & 0xffff), at, words_[at] >> 16);
  }
  static void append(std::vector<uint32_t>& out, spv::Op op, std::initializer_list<uint32_t> operands) {
    out.push_back(uint32_t(operands.size() + 1) << 16 | uint32_t(op));
    out.insert(out.end(), operands);
  }

  void read_declarations() {
    for_each([&](spv::Op op, size_t at, size_t length) {
      if (op == spv::Op::OpCapability)
        is_vendor_ |= words_[at + 1] == uint32_t(spv::Capability::RayTracingNV);
      if (op == spv::Op::OpExtension)
        has_extension_ |=
            std::string_view(reinterpret_cast<const char*>(&words_[at + 1])) == "SPV_KHR_ray_tracing";
      if (op == spv::Op::OpDecorate && length == 4 &&
          spv::Decoration(words_[at + 2]) == spv::Decoration::Location)
        location_[words_[at + 1]] = words_[at + 3];
      if (op == spv::Op::OpVariable) storage_[words_[at + 2]] = Storage(words_[at + 3]);
      if (op == spv::Op::OpConstant && length == 4) constant_[words_[at + 2]] = words_[at + 3];
    });
  }

  // Returns the variable of a location: the shader's own if there is one, otherwise the incoming one.
  std::optional<uint32_t> find(uint32_t constant, bool calls) const {
    const auto wanted = constant_.find(constant);
    if (wanted == constant_.end()) return std::nullopt;
    for (const Missing& m : missing_)
      if (m.location == wanted->second && m.calls == calls) return m.variable;
    for (const Storage storage : {calls ? Storage::CallableDataKHR : Storage::RayPayloadKHR,
                                  calls ? Storage::IncomingCallableDataKHR : Storage::IncomingRayPayloadKHR})
      for (const auto& [variable, location] : location_)
        if (const auto it = storage_.find(variable);
            location == wanted->second && it != storage_.end() && it->second == storage)
          return variable;
    return std::nullopt;
  }

  // Choice: a trace or call that names a location without a variable hands over a structure without members.
  struct Missing {
    uint32_t location;
    bool calls;
    uint32_t structure, pointer, variable;
  };
  void add_missing_variables() {
    bound_ = words_[kBoundWord];
    for_each([&](spv::Op op, size_t at, size_t length) {
      const bool calls = op == spv::Op::OpExecuteCallableNV;
      if (!calls && op != spv::Op::OpTraceNV && op != spv::Op::OpTraceMotionNV) return;
      const auto location = constant_.find(words_[at + length - 1]);
      if (location == constant_.end() || find(location->first, calls)) return;
      missing_.push_back({location->second, calls, bound_, bound_ + 1, bound_ + 2});
      bound_ += 3;
    });
  }
  // Types and variables are declared before the first function, because there their section ends.
  void declare(std::vector<uint32_t>& out) {
    if (std::exchange(are_declared_, true)) return;
    for (const Missing& m : missing_) {
      const auto storage = uint32_t(m.calls ? Storage::CallableDataKHR : Storage::RayPayloadKHR);
      append(out, spv::Op::OpTypeStruct, {m.structure});
      append(out, spv::Op::OpTypePointer, {m.pointer, storage, m.structure});
      append(out, spv::Op::OpVariable, {m.pointer, m.variable, storage});
    }
  }

  const std::vector<uint32_t>& words_;
  uint32_t bound_ = 0;
  std::vector<Missing> missing_;
  bool are_declared_ = false;
  bool is_vendor_ = false, has_extension_ = false;
  std::map<uint32_t, uint32_t> location_, constant_;
  std::map<uint32_t, Storage> storage_;
};

}  // namespace

std::vector<uint32_t> with_standard_traces(const std::vector<uint32_t>& spirv) {
  return Rewriter(spirv).run();
}

}  // namespace glint::frontend
