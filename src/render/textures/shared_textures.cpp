#include "render/textures/shared_textures.hpp"

#include <algorithm>

namespace microtrace {

SharedTextures::SharedTextures(const SharedTextures& previous, const Scene& scene) {
  const std::scoped_lock lock(previous.mutex_);
  for (const auto& [key, pyramid] : previous.pyramids_) {
    const Image* const image = key.first;
    if (std::ranges::any_of(scene.images, [&](const auto& own) { return own.get() == image; }))
      pyramids_.insert({key, pyramid});
  }
}

TextureMap SharedTextures::map(const std::shared_ptr<const Image>& image, const Sampler& sampler,
                               ColorEncoding encoding) {
  const std::scoped_lock lock(mutex_);
  std::shared_ptr<TexturePyramid>& pyramid = pyramids_[{image.get(), encoding}];
  if (!pyramid) pyramid = std::make_shared<TexturePyramid>(image, encoding);
  return {pyramid, sampler};  // makes mip maps if the sampler needs them
}

}  // namespace microtrace
