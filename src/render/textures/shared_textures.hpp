#pragma once
/// The mip maps of images, which scenes with the same images share.

#include "render/textures/texture_map.hpp"

#include <microtrace/scene.hpp>
#include <microtrace/texture.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace microtrace {

/// Each mip map is made on first use. Any number of threads may use it.
class SharedTextures {
 public:
  SharedTextures() = default;
  /// Takes over the mip maps of `previous` that the scene's images need.
  SharedTextures(const SharedTextures& previous, const Scene& scene);

  [[nodiscard]] TextureMap map(const std::shared_ptr<const Image>& image, const Sampler& sampler,
                               ColorEncoding encoding);

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<const Image*, ColorEncoding>, std::shared_ptr<TexturePyramid>> pyramids_;
};

}  // namespace microtrace
