#include "io/gltf/animation/property.hpp"

#include "io/gltf/check/schema/schema.hpp"
#include "io/gltf/document/index_text.hpp"
#include "io/gltf/extensions/extensions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>

namespace microtrace::io::gltf {
namespace {

constexpr std::array<std::string_view, 3> kAnimatedMembers = {"materials", "cameras", "extensions"};

const JsonValue* item_of(const JsonValue& array, std::string_view token) {
  const std::optional<std::size_t> index = index_in(token);
  return index ? array.find(*index) : nullptr;
}

/// Follows a JSON pointer through the asset and, at the same time, through the schema's rules.
class Walk {
 public:
  explicit Walk(const Asset& asset) : object_(asset.root().value) {}

  /// Returns the rule of the property that the tokens name, or null.
  const Rule* follow(std::span<const std::string> tokens) {
    while (!tokens.empty()) {
      if (tokens[0] == "extensions") {
        if (tokens.size() < 3 || !enter_extension(tokens[1])) return nullptr;
        tokens = tokens.subspan(2);
        continue;
      }
      const auto rule = std::ranges::find(rules_, std::string_view(tokens[0]), &Rule::key);
      if (rule == rules_.end()) return nullptr;
      if (tokens.size() == 1) return &*rule;
      object_ = object_->find(tokens[0]);
      if (object_ == nullptr) return nullptr;
      tokens = tokens.subspan(1);
      if (rule->form == Form::objects) {
        object_ = item_of(*object_, tokens[0]);
        if (object_ == nullptr) return nullptr;
        tokens = tokens.subspan(1);
      } else if (rule->form != Form::object) {
        return nullptr;
      }
      rules_ = rule->members;
      place_ = rule->place;
    }
    return nullptr;
  }

 private:
  bool enter_extension(std::string_view name) {
    const JsonValue* extensions = object_->find("extensions");
    object_ = extensions != nullptr ? extensions->find(name) : nullptr;
    if (object_ == nullptr) return false;
    const Extension* known = find_extension(name);
    const ExtensionObject* here = known != nullptr ? known->object_in(place_) : nullptr;
    if (here == nullptr) return false;
    rules_ = here->rules;
    place_ = Place::other;
    return true;
  }

  const JsonValue* object_;
  std::span<const Rule> rules_ = gltf_rules();
  Place place_ = Place::root;
};

JsonValue& make_member(JsonValue& object, const std::string& key) {
  if (JsonValue* value = object.find(key)) return *value;
  return object.add(key);
}

/// Returns the items of an array. Empty if the object or the array is absent.
std::span<JsonValue> items(JsonValue* object, std::string_view key) {
  JsonValue* array = object != nullptr ? object->find(key) : nullptr;
  return array != nullptr ? std::span(array->edit_items()) : std::span<JsonValue>();
}

JsonValue* extension_of(JsonValue& object, std::string_view name) {
  JsonValue* extensions = object.find("extensions");
  return extensions != nullptr ? extensions->find(name) : nullptr;
}

void repair_perspective(JsonValue& camera) {
  JsonValue* yfov = camera.find("yfov");
  yfov->set(JsonValue(std::clamp<double>(yfov->number(), std::numeric_limits<float>::min(),
                                         std::nextafter(std::numbers::pi, 0))));
  const JsonValue* far = camera.find("zfar");
  if (far == nullptr || far->number() > camera.find("znear")->number()) return;
  camera.remove_members([](std::string_view key) { return key == "zfar"; });
}

void repair_orthographic(JsonValue& camera) {
  constexpr double kLeast = 1e-6;
  for (const char* key : {"xmag", "ymag"}) {
    JsonValue& magnitude = *camera.find(key);
    if (std::abs(magnitude.number()) < kLeast) magnitude.set(JsonValue(kLeast));
  }
  const double near = camera.find("znear")->number();
  JsonValue& far = *camera.find("zfar");
  if (far.number() <= near) far.set(JsonValue(near + std::max(kLeast, kLeast * near)));
}

void repair_cone(JsonValue& light) {
  JsonValue* spot = light.find("spot");
  JsonValue* inner = spot != nullptr ? spot->find("innerConeAngle") : nullptr;
  if (inner == nullptr) return;
  const JsonValue* outer = spot->find("outerConeAngle");
  const double angle = outer != nullptr ? outer->number() : std::numbers::pi / 4;
  inner->set(JsonValue(std::min(inner->number(), std::nextafter(angle, 0))));
}

}  // namespace

std::optional<AnimatedProperty> find_property(const Asset& asset, std::string_view pointer) {
  std::optional<std::vector<std::string>> tokens = pointer_tokens(pointer);
  if (!tokens) return std::nullopt;
  AnimatedProperty property{.path = *std::move(tokens)};
  const Rule* rule = Walk(asset).follow(property.path);
  if (rule == nullptr) return std::nullopt;
  const std::string& first = property.path[0];
  if (first == "nodes" && rule->form == Form::boolean) {
    property.is_boolean = true;
    return property;
  }
  if (std::ranges::find(kAnimatedMembers, first) == kAnimatedMembers.end()) return std::nullopt;
  if (rule->form == Form::numbers && rule->fewest == rule->most) {
    property.is_array = true;
    property.width = rule->most;
  } else if (rule->form != Form::number) {
    return std::nullopt;
  }
  property.min = rule->above_min ? std::numeric_limits<float>::min() : rule->min;
  property.max = rule->max;
  return property;
}

JsonValue animated_part(const JsonValue& root) {
  std::vector<JsonMember> animated;
  std::ranges::copy_if(root.members(), std::back_inserter(animated), [](const JsonMember& member) {
    return std::ranges::find(kAnimatedMembers, member.key) != kAnimatedMembers.end();
  });
  return JsonValue(std::move(animated));
}

void set_property(JsonValue& part, const AnimatedProperty& property,
                  const std::vector<double>& value) {
  JsonValue* at = &part;
  for (const std::string& token : std::span(property.path).first(property.path.size() - 1)) {
    at = at->kind() == JsonValue::Kind::array ? at->find(index_in(token).value()) : at->find(token);
  }
  std::vector<JsonValue> numbers;
  numbers.reserve(value.size());
  for (const double x : value) numbers.emplace_back(std::clamp(x, property.min, property.max));
  JsonValue& target = make_member(*at, property.path.back());
  target.set(property.is_array ? JsonValue(std::move(numbers)) : std::move(numbers[0]));
}

void repair_properties(JsonValue& part) {
  for (JsonValue& camera : items(&part, "cameras")) {
    if (JsonValue* perspective = camera.find("perspective")) repair_perspective(*perspective);
    if (JsonValue* orthographic = camera.find("orthographic")) repair_orthographic(*orthographic);
  }
  for (JsonValue& light : items(extension_of(part, "KHR_lights_punctual"), "lights")) {
    repair_cone(light);
  }
  for (JsonValue& material : items(&part, "materials")) {
    JsonValue* refraction = extension_of(material, "KHR_materials_ior");
    JsonValue* ior = refraction != nullptr ? refraction->find("ior") : nullptr;
    // In this extension, an index of refraction of 0 means infinity.
    if (ior != nullptr && ior->number() > 0 && ior->number() < 1) ior->set(JsonValue(1.0));
  }
}

}  // namespace microtrace::io::gltf
