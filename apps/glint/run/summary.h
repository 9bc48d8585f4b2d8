// Makes the summary that the terminal shows from what a render returns.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/render.h"
#include "report/terminal/summary.h"

namespace glint::app {

report::Summary summarise(const pipeline::RenderJob& job, const pipeline::RenderResult& result);

}  // namespace glint::app
