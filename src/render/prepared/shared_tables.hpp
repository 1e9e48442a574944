#pragma once
/// Mip maps and sampling tables, shared by scenes with the same images and environment maps; and a
/// scene's tree, to be fitted to the next scene.

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
  /// Keeps of another's tables those of images that the scene shows, and the environment's.
  SharedTables(const SharedTables& previous, const Scene& scene);

  [[nodiscard]] TextureMap texture_map(const std::shared_ptr<const Image>& image,
                                       const Sampler& sampler, ColorEncoding encoding);

  /// Null before it was set.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;
  void set_tree(std::shared_ptr<const BvhTree> tree);

  /// Null for a uniform environment.
  [[nodiscard]] std::shared_ptr<const MapTables> of(const Environment& environment);

 private:
  mutable std::mutex mutex_;
  std::map<std::pair<const Image*, ColorEncoding>, std::shared_ptr<TexturePyramid>> pyramids_;
  std::shared_ptr<const BvhTree> tree_;
  std::shared_ptr<const MapTables> environment_;  // of the map that was asked for last
};

}  // namespace microtrace
