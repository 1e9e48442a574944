#pragma once
/// Mip maps and sampling tables that scenes with the same images and environment maps share. Also
/// keeps the tree of the previous scene, which is refitted to the next scene.

#include "render/lights/environment_light.hpp"
#include "render/textures/texture_map.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/texture.hpp>

#include <map>
#include <memory>
#include <mutex>
#include <utility>

namespace microtrace {

/// Each table is made on first use. Any number of threads may use it.
class SharedTables {
 public:
  SharedTables() = default;
  /// Takes over the tables of `previous` that the scene's images and environment need.
  SharedTables(const SharedTables& previous, const Scene& scene);

  [[nodiscard]] TextureMap texture_map(const std::shared_ptr<const Image>& image,
                                       const Sampler& sampler, ColorEncoding encoding);

  /// The tree; null until it is set.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;
  void set_tree(std::shared_ptr<const BvhTree> tree);

  /// The sampling tables of an environment; null for a uniform environment.
  [[nodiscard]] std::shared_ptr<const MapTables> of(const Environment& environment);

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<const Image*, ColorEncoding>, std::shared_ptr<TexturePyramid>> pyramids_;
  std::shared_ptr<const BvhTree> tree_;
  std::shared_ptr<const MapTables> environment_;  // tables of the last map requested
};

}  // namespace microtrace
