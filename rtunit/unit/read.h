// Says what a lane of the RT unit reads next, and which pipeline tests it when it has arrived.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "rtunit/traversal/ray_path.h"

namespace glint::rt {

class WalkHook;

// Numbers a test pipeline. TestPipelines::add() gives out the numbers after these.
using Pipe = uint8_t;
inline constexpr Pipe kBoxPipe = 0, kTrianglePipe = 1, kTransformPipe = 2;
inline constexpr Pipe kNoPipe = 0xff;  // What is read needs no test.

constexpr Pipe pipe_of(NodeKind kind) {
  switch (kind) {
    case NodeKind::Instance:
      return kTransformPipe;
    case NodeKind::Triangle:
    case NodeKind::TriangleSecond:
      return kTrianglePipe;
    default:
      return kBoxPipe;
  }
}

struct Read {
  Fetch what;
  WalkHook* errand = nullptr;  // hook that asked for it; null: it is the ray's next node
  Pipe pipe = kBoxPipe;

  // Sets each part by itself: a copy of the whole would make the host wait for the stores of its parts.
  void set(const Fetch& fetch, Pipe in_pipe, WalkHook* for_hook) {
    what.address = fetch.address;
    what.bytes = fetch.bytes;
    what.kind = fetch.kind;
    errand = for_hook;
    pipe = in_pipe;
  }
};

}  // namespace glint::rt
