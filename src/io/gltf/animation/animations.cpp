#include "io/gltf/animation/animations.hpp"

#include "base/text/printable.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/index_text.hpp"
#include "io/gltf/document/properties.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

namespace microtrace::io::gltf {
namespace {

using Numbers = std::shared_ptr<const std::vector<float>>;

template <typename Vector>
std::vector<float> flattened(const std::vector<Vector>& vectors) {
  std::vector<float> result;
  result.reserve(vectors.size() * static_cast<std::size_t>(Vector::length()));
  for (const Vector& v : vectors) {
    for (glm::length_t i = 0; i < Vector::length(); ++i) result.push_back(v[i]);
  }
  return result;
}

/// Returns the number of morph targets of the mesh's primitive with the most, see
/// morph_target_count.
std::size_t target_count(const Model& model, std::optional<std::size_t> mesh) {
  std::size_t most = 0;
  if (!mesh) return most;
  for (const Model::Primitive& primitive : model.meshes[*mesh].primitives)
    most = std::max(most, primitive.targets.size());
  return most;
}

}  // namespace

/// Reads channels and decodes each accessor once.
class AnimationPlayer::Reader {
 public:
  Reader(Asset& asset, const Model& model, AccessorReader& reader)
      : asset_(asset), model_(model), reader_(reader) {}

  std::optional<Channel> read(const Element& animation, const Element& channel) {
    const std::optional<Target> target = target_of(channel.member("target"));
    if (!target) return std::nullopt;
    const std::optional<std::size_t> width = width_of(*target);
    if (!width) return std::nullopt;
    const Element number = channel.member("sampler");
    const Element sampler = animation.member("samplers").item(index_from(*number.value));
    if (!has_data(sampler)) {
      asset_.warn(channel, "needs data that is not there; it is ignored");
      return std::nullopt;
    }
    if (target->is_pointed_at && !fits(sampler, *target, *width)) {
      asset_.warn(
          sampler.member("output"),
          "has a type or number of elements that doesn't fit the property its pointer names; the "
          "channel is ignored");
      return std::nullopt;
    }
    Keyframes keys = keyframes(sampler, target->path == Path::rotation, *width);
    if (keys.times->empty()) return std::nullopt;
    return Channel{.node = target->node,
                   .path = target->path,
                   .property = target->property,
                   .keys = std::move(keys)};
  }

 private:
  struct Target {
    Element at;
    std::size_t node;
    Path path;
    AnimatedProperty property{};
    bool is_pointed_at = false;  ///< by KHR_animation_pointer
  };

  /// Returns the node and property that a channel animates. A KHR_animation_pointer may refer to a
  /// property of a node, such as /nodes/0/rotation, or of another object.
  std::optional<Target> target_of(const Element& at) {
    const Element name = at.member("path");
    if (name.value->string() == "pointer") {
      const std::optional<Element> pointer = extension(at, "KHR_animation_pointer");
      return pointer ? pointed_at(pointer->member("pointer")) : std::nullopt;
    }
    const JsonValue* node = at.value->find("node");
    if (node == nullptr) return std::nullopt;
    const std::optional<Path> path = path_of(name.value->string());
    if (!path) warn_of(name);
    if (!path) return std::nullopt;
    return Target{at.member("node"), index_from(*node), *path};
  }

  std::optional<Target> pointed_at(const Element& pointer) {
    constexpr std::string_view kNodes = "/nodes/";
    const std::string_view text = pointer.value->string();
    const std::size_t slash = text.rfind('/');
    if (text.starts_with(kNodes) && slash >= kNodes.size()) {
      const auto node = index_in(text.substr(kNodes.size(), slash - kNodes.size()));
      const std::optional<Path> path = path_of(text.substr(slash + 1));
      if (node && *node < model_.nodes.size() && path)
        return Target{pointer, *node, *path, {}, true};
    }
    std::optional<AnimatedProperty> property = find_property(asset_, text);
    if (!property) property = misspelled_angle(pointer);
    if (!property) {
      warn_of(pointer);
      return std::nullopt;
    }
    if (!property->is_boolean) return Target{pointer, 0, Path::property, *property, true};
    return Target{pointer, index_in(property->path[1]).value(), Path::visibility, *property, true};
  }

  /// Finds the angle of a spot light whose pointer has the spelling of Blender 5.0,
  /// spot.outerConeAngle.
  std::optional<AnimatedProperty> misspelled_angle(const Element& pointer) {
    constexpr std::string_view kWrong = "/spot.", kRight = "/spot/";
    std::string text(pointer.value->string());
    const std::size_t at = text.rfind(kWrong);
    if (at == std::string::npos) return std::nullopt;
    text.replace(at, kWrong.size(), kRight);
    std::optional<AnimatedProperty> property = find_property(asset_, text);
    if (property) {
      asset_.tolerate(pointer, "names " + in_quotes(pointer.value->string()) +
                                   ", which does not exist; " + in_quotes(text) + " is animated");
    }
    return property;
  }

  void warn_of(const Element& at) {
    asset_.warn(
        at, "animation of " + in_quotes(at.value->string()) + " is not supported; it is ignored");
  }

  static std::optional<Path> path_of(std::string_view text) {
    constexpr std::array<std::pair<std::string_view, Path>, 4> kPaths = {
        {{"translation", Path::translation},
         {"rotation", Path::rotation},
         {"scale", Path::scale},
         {"weights", Path::weights}}};
    for (const auto& [name, path] : kPaths) {
      if (text == name) return path;
    }
    return std::nullopt;
  }

  /// Returns the number of components of one value. Returns nothing if the target can't be
  /// animated.
  std::optional<std::size_t> width_of(const Target& target) {
    const auto& [at, node, path, property, is_pointed_at] = target;
    if (path == Path::property || path == Path::visibility) return property.width;
    const Model::Node& animated = model_.nodes[node];
    if (path == Path::weights) {
      const std::size_t targets = target_count(model_, animated.mesh);
      if (targets != 0) return targets;
      asset_.warn(at, "animates the weights of a node without morph targets; it is ignored");
      return std::nullopt;
    }
    if (animated.matrix) {  // check_animations warned only if the channel has no pointer
      asset_.tolerate(at, "animates a node that has a matrix; it is ignored");
      return std::nullopt;
    }
    return path == Path::rotation ? 4 : 3;
  }

  /// Returns true if the sampler's accessors fit a target of KHR_animation_pointer, whose values
  /// have `width` components. Numbers may be floats or integers. Booleans require integers and STEP
  /// interpolation. check_animations has checked the samplers of other targets.
  bool fits(const Element& sampler, const Target& target, std::size_t width) const {
    const Model::Accessor& in = accessor(sampler.member("input"));
    const Model::Accessor& out = accessor(sampler.member("output"));
    const JsonValue* kind = sampler.value->find("interpolation");
    const bool is_step = kind != nullptr && kind->string() == "STEP";
    const bool is_array = target.path == Path::weights;
    const std::size_t values = (kind != nullptr && kind->string() == "CUBICSPLINE" ? 3 : 1) *
                               (is_array ? width : std::size_t{1});
    if (in.type != ElementType::scalar || in.component_type != kFloat32 || is_matrix(out.type) ||
        component_count(out.type) != (is_array ? 1 : width) || out.count != in.count * values) {
      return false;
    }
    const bool is_float = out.component_type == kFloat32;
    return target.path != Path::visibility || (!is_float && is_step);
  }

  bool has_data(const Element& sampler) const {
    return reader_.has_data(accessor_of(sampler.member("input"))) &&
           reader_.has_data(accessor_of(sampler.member("output")));
  }

  static std::size_t accessor_of(const Element& at) { return index_from(*at.value); }

  const Model::Accessor& accessor(const Element& at) const {
    return model_.accessors[accessor_of(at)];
  }

  Keyframes keyframes(const Element& sampler, bool are_rotations, std::size_t width) {
    const Element input = sampler.member("input"), output = sampler.member("output");
    Keyframes keys{.are_rotations = are_rotations,
                   .width = width,
                   .times = numbers(input),
                   .values = numbers(output)};
    std::size_t values_of_key = 1;
    if (const JsonValue* kind = sampler.value->find("interpolation")) {
      if (kind->string() == "STEP") keys.interpolation = Interpolation::step;
      if (kind->string() == "CUBICSPLINE") {
        keys.interpolation = Interpolation::cubic_spline;
        values_of_key = 3;
      }
    }
    const std::size_t wanted = keys.times->size() * values_of_key * width;
    if (keys.values->size() != wanted) {
      const std::size_t size = component_count(accessor(output).type);
      asset_.fail(output, "has " + std::to_string(keys.values->size() / size) + " elements; " +
                              std::to_string(keys.times->size()) + " keys need " +
                              std::to_string(wanted / size));
    }
    repair(input, output, keys);
    return keys;
  }

  /// Removes invalid keys. Examines each accessor only once, even if several samplers share it.
  void repair(const Element& input, const Element& output, Keyframes& keys) {
    const auto [ascends, new_times] = ascends_.try_emplace(accessor_of(input));
    if (new_times) ascends->second = is_ascending(*keys.times);
    const auto [is_finite, new_values] = finite_.try_emplace(accessor_of(output));
    if (new_values) is_finite->second = are_finite(*keys.values);
    if (ascends->second && is_finite->second) return;
    const std::size_t count = keys.times->size();
    charge(output, count + keys.values->size());
    keep_ascending(keys);
    asset_.tolerate(input, "has " + std::to_string(count - keys.times->size()) +
                               " keyframes whose times do not ascend, or with "
                               "values that are not finite; they are left out");
  }

  void charge(const Element& at, std::size_t count) {
    count_ += count;
    if (count_ > kMaxElements) {
      asset_.fail(at, "brings the animations to more than 2^27 numbers, the limit",
                  ErrorKind::limit);
    }
  }

  Numbers numbers(const Element& at) {
    const std::size_t index = accessor_of(at);
    Numbers& result = numbers_[index];
    if (result) return result;
    const Model::Accessor& source = accessor(at);
    charge(at, source.count * component_count(source.type));
    result = std::make_shared<const std::vector<float>>(
        source.type == ElementType::scalar ? reader_.read<float>(index)
        : source.type == ElementType::vec2 ? flattened(reader_.read<glm::vec2>(index))
        : source.type == ElementType::vec3 ? flattened(reader_.read<Vec3>(index))
                                           : flattened(reader_.read<glm::vec4>(index)));
    return result;
  }

  Asset& asset_;
  const Model& model_;
  AccessorReader& reader_;
  std::unordered_map<std::size_t, Numbers> numbers_;        // by accessor
  std::unordered_map<std::size_t, bool> ascends_, finite_;  // by accessor; filled on first use
  std::size_t count_ = 0;  // total count of numbers in all samplers
};

AnimationPlayer::AnimationPlayer(Asset& asset, const Model& model, AccessorReader& reader,
                                 const std::vector<std::size_t>& animations) {
  Reader channel_reader(asset, model, reader);
  for (const std::size_t index : animations) {
    const Element animation = asset.element("animations", index);
    const Element channels = animation.member("channels");
    for (std::size_t i = 0; i < channels.value->items().size(); ++i) {
      std::optional<Channel> channel = channel_reader.read(animation, channels.item(i));
      if (!channel) continue;
      if (channel->path == Path::property && !properties_) {
        properties_ = animated_part(*asset.root().value);
      }
      channels_.push_back(std::move(*channel));
    }
  }
}

}  // namespace microtrace::io::gltf
