#pragma once
/// Tables shared by scenes with the same images and environment maps: mip maps and sampling tables.
/// Also keeps the tree of one scene, which is refitted to the next.

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
  /// Keeps those tables of `previous` that the scene's images and environment need.
  SharedTables(const SharedTables& previous, const Scene& scene);

  [[nodiscard]] TextureMap texture_map(const std::shared_ptr<const Image>& image,
                                       const Sampler& sampler, ColorEncoding encoding);

  /// Null until it is set.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;
  void set_tree(std::shared_ptr<const BvhTree> tree);

  /// Null for a uniform environment.
  [[nodiscard]] std::shared_ptr<const MapTables> of(const Environment& environment);

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<const Image*, ColorEncoding>, std::shared_ptr<TexturePyramid>> pyramids_;
  std::shared_ptr<const BvhTree> tree_;
  std::shared_ptr<const MapTables> environment_;  // of the last map requested
};

}  // namespace microtrace
