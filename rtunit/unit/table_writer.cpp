// Collects what visits put into candidate tables, and sends it.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/table_writer.h"

#include <bit>

#include "base/num_lanes.h"

namespace glint::rt {

TableWriter::TableWriter(mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, const TableLayout& tables)
    : l1_(l1),
      buffer_(buffer),
      stats_(stats),
      tables_(tables),
      waiting_(buffer.size()),
      unsent_(buffer.size()) {
}

// Whatever a visit has put into the lane's table goes to memory.
void TableWriter::visited(const Visit& visit) {
  if (!visit.ray.table) return;
  const uint32_t added = visit.ray.table->take_unwritten();
  if (!added) return;
  Unsent& unsent = unsent_[visit.slot];
  if (!unsent.rows) waiting_.push(visit.slot);
  buffer_.add_writes(visit.slot, num_lanes(added & ~unsent.rows));
  for (uint32_t rest = added; rest; rest &= rest - 1)
    unsent.lanes[size_t(std::countr_zero(rest))] |= LaneMask{1} << visit.lane;
  unsent.rows |= added;
}

bool TableWriter::send(Cycle now) {
  const uint32_t slot = waiting_.front();
  Unsent& unsent = unsent_[slot];
  const auto row = uint32_t(std::countr_zero(unsent.rows));
  LaneMask& lanes = unsent.lanes[row];
  const uint32_t lanes_a_line = l1_.line_bytes() / kTableEntryBytes,
                 first = uint32_t(std::countr_zero(lanes)) / lanes_a_line * lanes_a_line;
  const LaneMask in_line = lanes >> first & ((LaneMask{1} << lanes_a_line) - 1);
  mem::Request request;
  request.line = tables_.entry(buffer_[slot].warp_slot, row, int(first));
  request.sectors = uint8_t(in_line);
  request.write = true;
  request.traffic = mem::Traffic::RtTable;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.table_writes;
  stats_.table_entries += num_lanes(in_line);
  lanes &= ~(in_line << first);
  if (lanes != 0) return true;
  unsent.rows &= ~(1u << row);
  if (unsent.rows == 0) waiting_.pop();
  buffer_.write_sent(slot, now);
  return true;
}

}  // namespace glint::rt
