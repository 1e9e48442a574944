#include "io/gltf/pose/instances.hpp"

#include "base/memory_account.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/gltf/pose/nodes.hpp"

#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include <glm/geometric.hpp>
#include <glm/vec4.hpp>

namespace microtrace::io::gltf {
namespace {

constexpr glm::dvec4 no_turn(0, 0, 0, 1);

double length_of(const glm::dvec4& quaternion) {
  return std::sqrt(glm::dot(quaternion, quaternion));
}

class Maker {
 public:
  Maker(Asset& asset, const Model& model, AccessorReader& reader, const Element& at)
      : asset_(asset), model_(model), reader_(reader), attributes_(at.member("attributes")) {}

  /// Makes the transforms of the instances. Returns nothing, with a warning, if there are no
  /// attributes, or an attribute has no data.
  std::optional<InstanceTransforms> make(std::size_t most) {
    std::optional<std::size_t> count;
    for (const JsonMember& member : attributes_.value->members()) {
      const std::size_t accessor = index(asset_, attributes_, member.key, model_.accessors.size());
      if (reader_.has_data(accessor)) continue;
      asset_.warn(attributes_.member(member.key),
                  "needs data that is not there; there are no instances");
      return std::nullopt;
    }
    for (const JsonMember& member : attributes_.value->members()) {
      const std::size_t accessor = index(asset_, attributes_, member.key, model_.accessors.size());
      const std::size_t size = model_.accessors[accessor].count;
      if (count && *count != size) {
        asset_.fail(attributes_.member(member.key), "has " + std::to_string(size) +
                                                        " elements, but an attribute before it " +
                                                        std::to_string(*count));
      }
      count = size;
    }
    if (!count) {
      asset_.warn(attributes_, "has no attributes; there are no instances");
      return std::nullopt;
    }
    if (*count > most) {
      asset_.fail(attributes_, "brings the asset to more than 2^22 instances, the limit",
                  ErrorKind::limit);
    }
    InstanceTransforms result{.count = *count,
                              .translations = read<Vec3>("TRANSLATION", ElementType::vec3, false),
                              .rotations = read<glm::vec4>("ROTATION", ElementType::vec4, true),
                              .scales = read<Vec3>("SCALE", ElementType::vec3, false)};
    for (const glm::vec4& rotation : result.rotations) check(glm::dvec4(rotation));
    return result;
  }

 private:
  template <typename Vector>
  std::vector<Vector> read(const char* name, ElementType type, bool may_be_normalized) {
    if (attributes_.value->find(name) == nullptr) return {};
    const std::size_t accessor = index(asset_, attributes_, name, model_.accessors.size());
    const Model::Accessor& source = model_.accessors[accessor];
    const bool is_float = source.component_type == kFloat32;
    const bool is_normalized = may_be_normalized && source.normalized &&
                               (source.component_type == kInt8 || source.component_type == kInt16);
    if (source.type != type || !(is_float || is_normalized)) {
      asset_.fail(attributes_.member(name),
                  may_be_normalized ? "must refer to an accessor of type VEC4 and float or "
                                      "normalized byte or short"
                                    : "must refer to an accessor of type VEC3 and float");
    }
    return reader_.read<Vector>(accessor);
  }

  void check(const glm::dvec4& quaternion) {
    const double length = length_of(quaternion);
    // Bytes represent unit quaternions to about 0.02.
    if (length > 0 && std::abs(length - 1) > 0.02)
      asset_.tolerate(attributes_.member("ROTATION"),
                      "has quaternions that are not of unit length, which are normalized");
    if (!(length > 0))
      asset_.tolerate(attributes_.member("ROTATION"), "has zero quaternions, which are ignored");
  }

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  Element attributes_;
};

}  // namespace

DMat4 InstanceTransforms::operator[](std::size_t instance) const {
  const glm::dvec4 turn = rotations.empty() ? no_turn : glm::dvec4(rotations[instance]);
  const double length = length_of(turn);
  return composed(translations.empty() ? DVec3(0) : DVec3(translations[instance]),
                  length > 0 ? turn / length : no_turn,
                  scales.empty() ? DVec3(1) : DVec3(scales[instance]));
}

Instances::Instances(Asset& asset, const Model& model, AccessorReader& reader) {
  std::size_t left = kMaxInstances;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (!model.nodes[i].has_extensions || !model.nodes[i].mesh) continue;
    const auto at = extension(asset.element("nodes", i), "EXT_mesh_gpu_instancing");
    if (!at) continue;
    if (at->value->find("attributes") == nullptr) {
      asset.fail(*at, "lacks the required property \"attributes\"");
    }
    auto transforms = Maker(asset, model, reader, *at).make(left);
    if (!transforms) transforms.emplace();
    left -= transforms->size();
    node_from_instance_.emplace(i, *std::move(transforms));
  }
}

const InstanceTransforms* Instances::of(std::size_t node) const {
  const auto found = node_from_instance_.find(node);
  return found != node_from_instance_.end() ? &found->second : nullptr;
}

}  // namespace microtrace::io::gltf
