// Checks a description against the shaders' reflection.
// SPDX-License-Identifier: Apache-2.0
#include "pipeline/description/check.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "isa/text.h"

namespace glint::pipeline {
namespace {

using frontend::BindingKind;

struct Given {
  const char* kind;  // the table's name in the file
  const Slot* slot;
  std::string name;
  SourceLocation where;
};

std::vector<Given> all_given(const PipelineDescription& d) {
  std::vector<Given> out;
  for (const auto& b : d.buffers) out.push_back({"buffer", &b.slot, b.name, b.where});
  for (const auto& i : d.images) out.push_back({"image", &i.slot, i.name, i.where});
  for (const auto& s : d.samplers) out.push_back({"sampler", &s.slot, s.name, s.where});
  for (const auto& t : d.top_levels) out.push_back({"top_level", &t.slot, t.name, t.where});
  return out;
}

std::string table_for(BindingKind kind) {
  switch (kind) {
    case BindingKind::UniformBuffer:
    case BindingKind::StorageBuffer:
      return "buffer";
    case BindingKind::StorageImage:
    case BindingKind::SampledImage:
      return "image";
    case BindingKind::AccelerationStructure:
      return "top_level";
    case BindingKind::Sampler:
      return "sampler";
    default:
      return "";
  }
}

std::string declared(const BindingUse& use) {
  return fmt::format("the shader declares the {} '{}' at {}", name_of(use.binding.kind), use.binding.name,
                     use.module->where_declared(use.binding).to_string());
}

class Check {
 public:
  Check(const PipelineDescription& d, const Modules& modules, std::vector<std::string>& warnings)
      : d_(d), modules_(modules), given_(all_given(d)), warnings_(warnings) {}

  void run() {
    for (const auto& [place, use] : modules_.bindings()) check_binding(place.first, place.second, use);
    for (const Given& g : given_)
      if (g.slot->is_bound() && !modules_.bindings().count({g.slot->set.value_or(0), *g.slot->binding}))
        warnings_.push_back(fmt::format("{}: note: no shader has set {} binding {}, so nobody uses '{}'",
                                        g.where.to_string(), g.slot->set.value_or(0), *g.slot->binding,
                                        g.name));
    for (const LaunchDescription& launch : d_.launches) {
      check_stage(launch.compute, isa::Stage::Compute, launch.where, "[compute]");
      if (launch.raygen) check_record(*launch.raygen, isa::Stage::RayGeneration, "[raygen]");
    }
    for (const auto& record : d_.miss.records) check_record(record, isa::Stage::Miss, "a miss record");
    for (const auto& record : d_.callable.records)
      check_record(record, isa::Stage::Callable, "a callable record");
    for (const auto& record : d_.hit.records) check_hit(record);
    for (const auto& group : d_.groups) check_hit_group(group);
    note_large_payloads();
    for (const auto& buffer : d_.buffers) check_saves(buffer.saves);
    for (const auto& image : d_.images) check_saves(image.saves);
    errors_.throw_if_errors();
  }

 private:
  // Something else writes these files of the run directory.
  void check_saves(const std::vector<Save>& saves) {
    static const std::vector<std::string> kOwn{"config.toml", "run.json",       "stats.txt",
                                               "stats.json",  "stats.csv",      "printf.txt",
                                               "profile.csv", "profile.folded", "series.csv"};
    for (const Save& save : saves) {
      if (std::find(kOwn.begin(), kOwn.end(), save.file) != kOwn.end())
        errors_.error(save.where, fmt::format("the run itself writes '{}'", save.file),
                      "save under another name");
      else if (!saved_.insert(save.file).second)
        errors_.error(save.where, fmt::format("'{}' is saved twice", save.file), "save under another name");
    }
  }

  void check_binding(uint32_t set, uint32_t binding, const BindingUse& use) {
    std::vector<const Given*> here;
    for (const Given& g : given_)
      if (g.slot->is_bound() && g.slot->set.value_or(0) == set && *g.slot->binding == binding)
        here.push_back(&g);
    const std::string table = table_for(use.binding.kind);
    if (here.empty()) {
      if (!use.is_used) return;  // The shader declares it and never reads it.
      errors_.error(
          {d_.path, 0, 0}, fmt::format("nothing is bound to set {} binding {}", set, binding),
          fmt::format("{}: add [[{}]] with set = {}, binding = {}", declared(use), table, set, binding));
      return;
    }
    std::set<uint32_t> elements;
    for (const Given* g : here) {
      if (g->kind != table)
        errors_.error(g->where,
                      fmt::format("set {} binding {}: '{}' is a [[{}]], and the shader wants a [[{}]]", set,
                                  binding, g->name, g->kind, table),
                      declared(use));
      if (!elements.insert(g->slot->element).second)
        errors_.error(
            g->where,
            fmt::format("set {} binding {} element {} is bound twice", set, binding, g->slot->element),
            !use.binding.is_array ? "" : "elements of an array of descriptors are element = 0, 1, ...");
      if (use.binding.count && g->slot->element >= use.binding.count)
        errors_.error(g->where,
                      fmt::format("element {} of set {} binding {}: the shader's array has {}",
                                  g->slot->element, set, binding, use.binding.count),
                      declared(use));
    }
    const uint32_t wanted = std::max(use.binding.count, *elements.rbegin() + 1);
    if (elements.size() < wanted && use.is_used) {
      uint32_t first = 0;
      while (elements.count(first)) ++first;
      errors_.error(here[0]->where,
                    fmt::format("set {} binding {} has {} elements, and element {} is missing", set, binding,
                                wanted, first),
                    declared(use));
    }
  }

  void check_stage(const std::string& name, isa::Stage stage, const SourceLocation& where,
                   const std::string& what) {
    if (name.empty()) return;
    const ShaderModule& module = modules_.find(name);
    if (module.reflection.stage != stage)
      errors_.error(where,
                    fmt::format("{} wants a shader of stage {}, and '{}' is of stage {}", what,
                                isa::name_of(stage), module.path, isa::name_of(module.reflection.stage)));
  }

  const GroupDescription* group_of(const RecordDescription& record) {
    if (record.group.empty()) return &record.inlined;
    std::vector<std::string> names;
    for (const GroupDescription& group : d_.groups) {
      if (group.name == record.group) return &group;
      names.push_back(group.name);
    }
    const std::string near = nearest(record.group, names);
    errors_.error(record.where, fmt::format("there is no group '{}'", record.group),
                  near.empty() ? "" : fmt::format("did you mean '{}'?", near));
    return nullptr;
  }

  void check_record(const RecordDescription& record, isa::Stage stage, const std::string& what) {
    const GroupDescription* group = group_of(record);
    if (!group) return;
    check_stage(group->general, stage, record.where, what);
    if (group->general.empty() && stage == isa::Stage::RayGeneration)
      errors_.error(record.where, "[raygen] needs 'shader'");
  }

  void check_hit(const RecordDescription& record) {
    const GroupDescription* group = group_of(record);
    if (group && record.group.empty()) check_hit_group(*group);
  }

  void check_hit_group(const GroupDescription& group) {
    check_stage(group.closest_hit, isa::Stage::ClosestHit, group.where, "'closest_hit'");
    check_stage(group.any_hit, isa::Stage::AnyHit, group.where, "'any_hit'");
    check_stage(group.intersection, isa::Stage::Intersection, group.where, "'intersection'");
  }

  // Notes payloads that are too large. Which payload a trace hands over is known only at run time, so a
  // payload is reported only when no trace can hand it over.
  void note_large_payloads() {
    uint32_t largest = 0;
    for (const ShaderModule& module : modules_.all())
      largest = std::max(largest, module.reflection.largest_payload_bytes);
    for (const ShaderModule& module : modules_.all())
      if (module.reflection.incoming_payload_bytes > largest)
        warnings_.push_back(
            fmt::format("{}: note: the shader reads a payload of {} bytes, and the largest that any shader "
                        "here hands to a trace has {}",
                        module.path, module.reflection.incoming_payload_bytes, largest));
      else
        note_other_payload(module);
  }

  // Notes a shader that reads what no trace of these shaders can hand over, scalar for scalar.
  void note_other_payload(const ShaderModule& module) {
    const std::string& read = module.reflection.incoming_payload;
    size_t agree = 0;  // letters in common with the nearest payload
    std::string nearest;
    bool fits = read.empty();
    for (const ShaderModule& caller : modules_.all())
      for (const std::string& handed : caller.reflection.handed_payloads) {
        const size_t end = std::min(read.size(), handed.size());
        const size_t same = size_t(
            std::mismatch(read.begin(), read.begin() + long(end), handed.begin()).first - read.begin());
        fits |= same == end;
        if (nearest.empty() || same > agree) agree = same, nearest = handed;
      }
    if (fits || nearest.empty()) return;
    const size_t scalar = agree / 2;
    warnings_.push_back(
        fmt::format("{}: note: scalar {} of the payload that the shader reads is {}, and the most similar "
                    "payload that a shader here hands to a trace has {} there",
                    module.path, scalar + 1, name_of_scalar(read.substr(2 * scalar, 2)),
                    name_of_scalar(nearest.substr(2 * scalar, 2))));
  }
  static std::string name_of_scalar(const std::string& scalar) {
    const int bits = 8 * (scalar[1] - '0');
    return scalar[0] == 'b' ? "a bool"
                            : fmt::format("{} of {} bits", scalar[0] == 'f' ? "a float" : "an integer", bits);
  }

  const PipelineDescription& d_;
  const Modules& modules_;
  const std::vector<Given> given_;
  std::vector<std::string>& warnings_;
  std::set<std::string> saved_;
  Diagnostics errors_;
};

}  // namespace

void check_pipeline(const PipelineDescription& description, const Modules& modules,
                    std::vector<std::string>& warnings) {
  Check(description, modules, warnings).run();
}

void check_bytes(const BindingUse& use, uint64_t bytes, const std::string& name, const SourceLocation& where,
                 Diagnostics& errors) {
  if (bytes < use.binding.block.bytes)
    errors.error(where,
                 fmt::format("buffer '{}' has {} bytes, and the shader's block needs {}", name, bytes,
                             use.binding.block.bytes),
                 declared(use));
}

}  // namespace glint::pipeline
