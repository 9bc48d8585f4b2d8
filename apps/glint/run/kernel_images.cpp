// Reads, places and saves images.
// SPDX-License-Identifier: Apache-2.0
#include "apps/glint/run/kernel_images.h"

#include <cstddef>
#include <fmt/format.h>
#include <set>
#include <utility>

#include "apps/glint/run/outputs.h"
#include "pipeline/description/pictures.h"
#include "pipeline/description/read.h"
#include "pipeline/description/value.h"

namespace glint::app {

std::vector<pipeline::KernelImage> read_kernel_images(const std::string& path) {
  const pipeline::Value file = pipeline::read_toml(path);
  pipeline::PipelineDescription folder;
  folder.path = path;
  Diagnostics errors;
  pipeline::Reading reading{folder, errors};
  pipeline::TableReader root(file, "a launch file", errors);
  std::vector<pipeline::KernelImage> out;
  std::set<std::string> names;
  for (const pipeline::Value* each : root.tables("image")) {
    out.push_back(pipeline::read_kernel_image(reading, *each));
    const pipeline::ImageDescription& image = out.back().image;
    if (!names.insert(image.name).second)
      errors.error(image.where, fmt::format("image '{}' is there twice", image.name));
    check_saves(image.saves, true, errors);
  }
  errors.throw_if_errors();
  return out;
}

std::vector<exec::ImageView> place_images(const std::vector<pipeline::KernelImage>& images,
                                          mem::AddressSpace& memory, uint32_t threads) {
  std::vector<pipeline::ImageDescription> descriptions;
  for (const pipeline::KernelImage& each : images) descriptions.push_back(each.image);
  const pipeline::PictureMaker maker(descriptions, threads);
  std::vector<exec::ImageView> out;
  for (const auto& [image, shape] : images) {
    pipeline::DeclaredImage declared;
    declared.shape = shape;
    pipeline::Picture picture = maker.make(image, declared, {1, 1, 1});
    picture.view.base = memory.allocate(image.name, picture.texels.size());
    memory.write(picture.view.base, picture.texels.data(), picture.texels.size());
    out.push_back(std::move(picture.view));
  }
  return out;
}

std::vector<std::string> keep_images(const std::vector<pipeline::KernelImage>& images,
                                     const std::vector<exec::ImageView>& views,
                                     const mem::AddressSpace& memory, const report::RunDirectory& directory,
                                     uint32_t threads) {
  std::vector<std::string> lines;
  for (size_t i = 0; i < images.size(); ++i)
    if (!images[i].image.saves.empty())
      for (std::string& line : save_image(images[i].image, views[i], memory, directory, threads))
        lines.push_back(std::move(line));
  return lines;
}

}  // namespace glint::app
