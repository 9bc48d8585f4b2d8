// Makes the summary that the terminal shows from what a render returns.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "pipeline/render.h"
#include "pipeline/sampling/estimates.h"
#include "report/files/run_directory.h"
#include "report/terminal/summary.h"

namespace glint::app {

report::Summary summarise(const pipeline::RenderJob& job, const pipeline::RenderResult& result);

// Adds the estimates of a sampled run, which the summary shows instead of the sample's own counts.
void add_sample(const report::SampleInfo& sample, std::span<const pipeline::Estimate> estimates,
                report::Summary& summary);

}  // namespace glint::app
