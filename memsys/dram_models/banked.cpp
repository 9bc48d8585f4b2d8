// Implements the DRAM model `banked`: it simulates the banks of a channel, with row buffers and refresh,
// command by command.
// SPDX-License-Identifier: Apache-2.0

#include "base/registry.h"
#include "memsys/dram/dram_channel.h"

namespace glint::mem {
namespace {

class Banked final : public DramChannel {
 public:
  static constexpr const char* kName = "banked";
  static constexpr const char* kDoc =
      "Banks, rows, command timing and refresh are modelled; `memory.dram.scheduler` orders the requests.";
  struct Params {
    static ParamList params() { return {}; }
  };
  Banked(const Params&, const Context& context) : DramChannel(context) {}
};

const Register<DramModel, Banked> registered;

}  // namespace
}  // namespace glint::mem
