#include "io/gltf/check/animation_pointer.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/element_types.hpp"
#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"

#include <optional>
#include <string>
#include <unordered_set>
#include <vector>

namespace microtrace::io::gltf {
namespace {

constexpr const char* kPointerExtension = "KHR_animation_pointer";

std::string text(double number) {
  return std::to_string(static_cast<unsigned long long>(number));
}

/// Returns true if glTF 2.0, section 3.11, allows this accessor format for a path.
bool is_allowed(const std::string& path, const Format& f) {
  if (path == "translation" || path == "scale") return f == Format{"VEC3", kFloat32};
  const char* type = path == "rotation" ? "VEC4" : "SCALAR";
  return is_one_of(f, {{type, kFloat32},
                       {type, kInt8, true},
                       {type, kUint8, true},
                       {type, kInt16, true},
                       {type, kUint16, true}});
}

class AnimationCheck {
 public:
  AnimationCheck(Asset& asset, AccessorHeads& accessors) : asset_(asset), accessors_(accessors) {}

  void animation(const Element& at) {
    const Element samplers = at.member("samplers");
    are_good_.clear();
    for (std::size_t i = 0; i < samplers.value->items().size(); ++i) {
      are_good_.push_back(input(samplers.item(i)));
    }
    const Element channels = at.member("channels");
    targets_.clear();
    for (std::size_t i = 0; i < channels.value->items().size(); ++i) {
      const Element channel = channels.item(i);
      const Element sampler = channel.member("sampler");
      if (sampler.value->number() >= static_cast<double>(samplers.value->items().size())) {
        asset_.fail(sampler, "is " + text(sampler.value->number()) +
                                 ", but the animation has only " +
                                 std::to_string(samplers.value->items().size()) + " samplers");
      }
      const auto index = index_from(*sampler.value);
      const Element target = channel.member("target");
      if (!are_good_[index] || !this->target(target, samplers.item(index))) leave_out(target);
    }
  }

 private:
  static bool is_spline(const Element& sampler) {
    const JsonValue* interpolation = sampler.value->find("interpolation");
    return interpolation != nullptr && interpolation->string() == "CUBICSPLINE";
  }

  /// Removes the channel's target. Readers ignore a channel without one (glTF 2.0, section 3.11).
  void leave_out(const Element& target) { asset_.drop(target, {"node", "extensions"}); }

  /// Warns about a violation that makes the channel unplayable. Returns false.
  bool wrong(const Element& at, const std::string& message) {
    asset_.tolerate(at, message + "; the channel is ignored");
    return false;
  }

  bool input(const Element& sampler) {
    const Element at = sampler.member("input");
    accessors_.use(at, Purpose::animation_input);
    accessors_.use(sampler.member("output"), Purpose::animation_output);
    const AccessorHead& head = accessors_[*at.value];
    if (head.format != Format{"SCALAR", kFloat32}) {
      return wrong(at, "refers to an accessor of " + head.format.text() +
                           "; animation times must be SCALAR of componentType 5126");
    }
    if (!head.has_bounds) {
      asset_.tolerate(asset_.element("accessors", index_from(*at.value)),
                      "holds animation times without min and max, which glTF 2.0 requires");
    }
    if (is_spline(sampler) && head.count < 2) {
      return wrong(at, "has one time, but CUBICSPLINE needs at least two");
    }
    return true;
  }

  bool target(const Element& at, const Element& sampler) {
    const JsonValue* index = at.value->find("node");
    const std::string& path = at.member("path").value->string();
    if (extension(at, kPointerExtension) || path == "pointer") return pointer(at);
    const bool known =
        path == "translation" || path == "rotation" || path == "scale" || path == "weights";
    if (index == nullptr || !known)
      return true;  // ignored (section 3.11), or defined by an extension
    const auto number = index_from(*index);
    const JsonValue& node = asset_.array("nodes")[number];
    if (path != "weights" && node.find("matrix") != nullptr) {
      return wrong(at.member("node"), "has a matrix, which can't be animated by " + path);
    }
    const std::size_t targets = morph_targets(node);
    if (path == "weights" && targets == 0) {
      return wrong(at.member("node"),
                   "has no mesh with morph targets, so its weights can't be animated");
    }
    if (!targets_.insert(std::to_string(number) + path).second) {
      asset_.tolerate(at, "is already the target of an earlier channel");
    }
    return output(sampler, path, targets);
  }

  /// Checks a channel of KHR_animation_pointer.
  bool pointer(const Element& at) {
    const std::optional<Element> own = extension(at, kPointerExtension);
    const Element path = at.member("path");
    if (!own) {
      // If the extension is not used, "pointer" is an unknown path.
      if (!asset_.uses(kPointerExtension)) return true;
      return wrong(path, "is \"pointer\" without an object of KHR_animation_pointer");
    }
    if (path.value->string() != "pointer") {
      return wrong(
          path, "must be \"pointer\", because the target has an object of KHR_animation_pointer");
    }
    const Element text = own->member("pointer");
    const std::string why = why_no_pointer(asset_, text.value->string());
    if (!why.empty()) return wrong(text, why);
    if (at.value->find("node") != nullptr) {
      asset_.tolerate(at.member("node"),
                      "must be absent if the target has a pointer; it is ignored");
      asset_.drop(at, {"node"});
    }
    return true;
  }

  [[nodiscard]] std::size_t morph_targets(const JsonValue& node) const {
    const JsonValue* mesh = node.find("mesh");
    if (mesh == nullptr) return 0;
    return morph_target_count(asset_.array("meshes")[index_from(*mesh)]);
  }

  bool output(const Element& sampler, const std::string& path, std::size_t targets) {
    const Element at = sampler.member("output");
    const AccessorHead& values = accessors_[*at.value];
    if (!is_allowed(path, values.format)) {
      return wrong(at, "refers to an accessor of " + values.format.text() +
                           ", which glTF 2.0 does not allow for " + path);
    }
    const double times = accessors_[*sampler.member("input").value].count;
    const double expected = times * (is_spline(sampler) ? 3 : 1) *
                            (path == "weights" ? static_cast<double>(targets) : 1);
    if (values.count == expected) return true;
    return wrong(at, "has " + text(values.count) + " elements for " + path + ", must have " +
                         text(expected) + " for " + text(times) + " times");
  }

  Asset& asset_;
  AccessorHeads& accessors_;
  std::vector<bool> are_good_;               // by sampler of the animation
  std::unordered_set<std::string> targets_;  // targets of earlier channels
};

}  // namespace

void check_animations(Asset& asset, AccessorHeads& accessors) {
  AnimationCheck check(asset, accessors);
  for (std::size_t i = 0; i < asset.array("animations").size(); ++i) {
    check.animation(asset.element("animations", i));
  }
}

}  // namespace microtrace::io::gltf
