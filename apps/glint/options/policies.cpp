// Names all interfaces with registered implementations. This is the only place that does.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/options/policies.h"

#include "base/registry.h"
#include "core/issue_scheduler.h"
#include "core/op_times.h"
#include "exec/warp_layout.h"
#include "memsys/dram_model.h"
#include "memsys/dram_scheduler.h"
#include "memsys/replacement.h"
#include "report/files/stat_writer.h"
#include "rtunit/any_hit_mode.h"
#include "rtunit/child_order.h"
#include "rtunit/coalescer.h"
#include "rtunit/node_format.h"
#include "rtunit/ray_scheduler.h"
#include "rtunit/stack_model.h"

namespace glint::app {
namespace {

template <class Interface>
void add(std::vector<PolicyInfo>& out, const char* key, const char* folder) {
  for (const auto& [name, entry] : Registry<Interface>::instance().entries())
    out.push_back({key, folder, std::string(name), std::string(entry.doc)});
}

}  // namespace

std::vector<PolicyInfo> all_policies() {
  std::vector<PolicyInfo> out;
  add<core::IssueScheduler>(out, "core.issue", "core/schedulers");
  add<core::OpTimes>(out, "core.op_times", "core/op_times");
  add<exec::WarpLayout>(out, "core.warp_layout", "exec/warp_layouts");
  add<mem::DramModel>(out, "memory.dram.model", "memsys/dram_models");
  add<mem::DramScheduler>(out, "memory.dram.scheduler", "memsys/dram_schedulers");
  add<mem::Replacement>(out, "*.replacement", "memsys/replacement");
  add<rt::AnyHitMode>(out, "rt.any_hit", "rtunit/any_hit");
  add<rt::RayScheduler>(out, "rt.scheduler", "rtunit/schedulers");
  add<rt::ChildOrder>(out, "rt.child_order", "rtunit/child_orders");
  add<rt::Coalescer>(out, "rt.coalescing", "rtunit/coalescers");
  add<rt::StackModel>(out, "rt.stack", "rtunit/stacks");
  add<rt::NodeFormat>(out, "bvh.format", "rtunit/formats");
  add<report::StatWriter>(out, "(statistics file)", "report/formats");
  return out;
}

}  // namespace glint::app
