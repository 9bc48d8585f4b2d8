// Sends the results of the RT unit's rays.
// SPDX-License-Identifier: Apache-2.0
#include "rtunit/unit/result_writer.h"

#include <bit>

namespace glint::rt {

ResultWriter::ResultWriter(mem::L1Port& l1, WarpBuffer& buffer, RtStats& stats, Address results)
    : l1_(l1),
      buffer_(buffer),
      stats_(stats),
      results_(results),
      waiting_(buffer.size()),
      unwritten_(buffer.size()) {
}

uint64_t ResultWriter::bytes(const Params& params) {
  return uint64_t{params.slots()} * kLanes * mem::kSectorBytes;
}

bool ResultWriter::holds(uint32_t slot, Cycle) {
  if (buffer_[slot].mask == 0) return false;  // All rays have gone back to the pool.
  unwritten_[slot] = buffer_[slot].mask;
  waiting_.push(slot);
  return true;
}

bool ResultWriter::send(Cycle now) {
  const uint32_t slot = waiting_.front();
  LaneMask& unwritten = unwritten_[slot];
  const uint32_t lanes_a_line = l1_.line_bytes() / mem::kSectorBytes;
  const uint32_t first = uint32_t(std::countr_zero(unwritten)) / lanes_a_line * lanes_a_line;
  const LaneMask in_line = unwritten >> first & ((LaneMask{1} << lanes_a_line) - 1);
  mem::Request request;
  request.line = results_ + (Address(slot) * kLanes + first) * mem::kSectorBytes;
  request.sectors = uint8_t(in_line);
  request.write = true;
  request.traffic = mem::Traffic::RtNode;
  if (!l1_.access(now, mem::Client::RtUnit, request)) return false;
  ++stats_.result_writes;
  unwritten &= ~(in_line << first);
  if (unwritten != 0) return true;
  waiting_.pop();
  buffer_.leave(slot, now);
  return true;
}

}  // namespace glint::rt
