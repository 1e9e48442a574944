#include "render/prepared/shared_tables.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace microtrace {

SharedTables::SharedTables(const SharedTables& previous, const Scene& scene) {
  const std::scoped_lock lock(previous.mutex_);
  environment_ = previous.environment_;
  for (const auto& [key, pyramid] : previous.pyramids_) {
    const Image* const image = key.first;
    if (std::ranges::any_of(scene.images, [&](const auto& own) { return own.get() == image; }))
      pyramids_.insert({key, pyramid});
  }
}

TextureMap SharedTables::texture_map(const std::shared_ptr<const Image>& image,
                                     const Sampler& sampler, ColorEncoding encoding) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<TexturePyramid>& pyramid = pyramids_[{image.get(), encoding}];
  if (!pyramid) pyramid = std::make_shared<TexturePyramid>(image, encoding);
  return {pyramid, sampler};  // makes mip maps if the sampler needs them
}

std::shared_ptr<const BvhTree> SharedTables::tree() const {
  const std::scoped_lock lock(mutex_);
  return tree_;
}

void SharedTables::set_tree(std::shared_ptr<const BvhTree> tree) {
  const std::scoped_lock lock(mutex_);
  tree_ = std::move(tree);
}

std::shared_ptr<const MapTables> SharedTables::of(const Environment& environment) {
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map == nullptr) return tables_of(environment);
  const std::scoped_lock lock(mutex_);
  if (!environment_ || environment_->map != *map) environment_ = tables_of(environment);
  return environment_;
}

}  // namespace microtrace
