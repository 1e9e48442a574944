#include "render/prepared/shared_tables.hpp"

#include <utility>
#include <variant>

namespace microtrace {

SharedTables::SharedTables(const SharedTables& previous, const Scene& scene)
    : textures_(previous.textures_, scene) {
  const std::scoped_lock lock(previous.mutex_);
  environment_ = previous.environment_;
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

std::shared_ptr<const RadianceMap> SharedTables::map() const {
  const std::scoped_lock lock(mutex_);
  return environment_ ? environment_->map : nullptr;
}

}  // namespace microtrace
