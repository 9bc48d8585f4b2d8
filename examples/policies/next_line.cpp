// Implements the prefetcher `next_line`: the bytes behind each internal node are read ahead.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/prefetcher.h"

namespace glint::rt {
namespace {

class NextLine final : public Prefetcher {
 public:
  static constexpr std::string_view kName = "next_line";
  static constexpr std::string_view kDoc = "The bytes behind each internal node are read ahead.";
  struct Params {
    uint32_t bytes = 64;
    static ParamList params() {
      return {param(&Params::bytes, "bytes", "byte", "Number of bytes that are read ahead.", 32, 4096)};
    }
  };
  NextLine(Params params, Context context)
      : bytes_(params.bytes), queue_(context.queue), stats_(context.stats) {}

  void visited(const Visit& visit) override {
    if (visit.node.kind != NodeKind::Internal) return;
    ++stats_.nodes;
    queue_.want({visit.node.address + visit.node.bytes, bytes_, NodeKind::Internal});
  }

 private:
  struct Stats {
    explicit Stats(stats::Group* parent) : group(parent, "next_line") {}
    stats::Group group;
    stats::Counter nodes{&group, "nodes", "node", "Number of nodes behind which bytes were asked for."};
  };

  const uint32_t bytes_;
  PrefetchQueue& queue_;
  Stats stats_;
};

const Register<Prefetcher, NextLine> registered;

}  // namespace
}  // namespace glint::rt
