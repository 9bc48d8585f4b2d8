// Sends an image op to its family.
// SPDX-License-Identifier: Apache-2.0
#include "exec/image_ops.h"

#include "base/check.h"

namespace glint::exec {

using isa::ImageRequest;

bool ImageOps::run(WarpContext& warp, const isa::Inst& inst, const isa::OpRow& row) {
  row.run(warp.regs, inst, row);
  texels_.clear();
  seen_.begin_access();
  bool ok = false;
  switch (row.image.request) {
    case ImageRequest::Sample:
    case ImageRequest::Gather:
    case ImageRequest::Fetch:
      ok = textures_.read(warp, inst, row);
      break;
    case ImageRequest::Query:
      ok = textures_.query(warp, inst, row);
      break;
    case ImageRequest::Texel:
    case ImageRequest::Bytes:
      ok = surfaces_.run(warp, inst, row);
      break;
    case ImageRequest::None:
      GLINT_PANIC("{} is not an image op", row.name);
  }
  if (ok) ++warp.simt.pc;
  return ok;
}

}  // namespace glint::exec
