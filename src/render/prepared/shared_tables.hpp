#pragma once
/// Mip maps and sampling tables that scenes with the same images and environment maps share. Also
/// keeps the tree of the previous scene, which is refitted to the next scene.

#include "render/lights/environment/environment_light.hpp"
#include "render/textures/shared_textures.hpp"

#include <microtrace/bvh.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/scene.hpp>

#include <memory>
#include <mutex>

namespace microtrace {

/// Each table is made on first use. Any number of threads may use it.
class SharedTables {
 public:
  SharedTables() = default;
  /// Takes over the tables of `previous` that the scene's images and environment need.
  SharedTables(const SharedTables& previous, const Scene& scene);

  [[nodiscard]] SharedTextures& textures() { return textures_; }

  /// The tree; null until it is set.
  [[nodiscard]] std::shared_ptr<const BvhTree> tree() const;
  void set_tree(std::shared_ptr<const BvhTree> tree);

  /// The sampling tables of an environment; null for a uniform environment.
  [[nodiscard]] std::shared_ptr<const MapTables> of(const Environment& environment);
  /// The last map for which tables were made; null if there was none.
  [[nodiscard]] std::shared_ptr<const RadianceMap> map() const;

 private:
  SharedTextures textures_;
  mutable std::mutex mutex_;
  std::shared_ptr<const BvhTree> tree_;
  std::shared_ptr<const MapTables> environment_;  // tables of the last map requested
};

}  // namespace microtrace
