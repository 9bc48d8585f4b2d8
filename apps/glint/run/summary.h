// From what a render returns to what the summary on the terminal shows.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "pipeline/render.h"
#include "report/terminal/summary.h"

namespace glint::app {

report::Summary summarise(const pipeline::RenderJob& job, const pipeline::RenderResult& result);

}  // namespace glint::app
