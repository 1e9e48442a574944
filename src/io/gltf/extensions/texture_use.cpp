#include "io/gltf/extensions/texture_use.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"
#include "scene/math/trigonometry.hpp"

#include <cmath>
#include <numbers>

namespace microtrace::io::gltf {
namespace {

/// Returns the transform of KHR_texture_transform. It scales, then rotates counterclockwise as seen
/// with v pointing down, then translates.
Mat3x2 texture_transform(const JsonValue& json) {
  const Vec2 offset = vector(json, "offset", Vec2(0)), scale = vector(json, "scale", Vec2(1));
  const JsonValue* rotation = json.find("rotation");
  // sin_radians and cos_radians accept angles up to 2^20.
  const double angle =
      rotation != nullptr ? std::fmod(rotation->number(), 2 * std::numbers::pi) : 0;
  const double sine = sin_radians(angle), cosine = cos_radians(angle);
  return {Vec2(cosine * scale.x, -sine * scale.x), Vec2(sine * scale.y, cosine * scale.y), offset};
}

}  // namespace

std::optional<TextureUse> texture_use(const JsonValue& object, std::string_view key) {
  const JsonValue* info = object.find(key);
  if (info == nullptr) return std::nullopt;
  TextureUse use{.texture = index(*info, "index"), .uv_set = index(*info, "texCoord")};
  if (const JsonValue* transform = extension(*info, "KHR_texture_transform")) {
    use.texture_from_uv = texture_transform(*transform);
    if (transform->find("texCoord") != nullptr) use.uv_set = index(*transform, "texCoord");
  }
  return use;
}

}  // namespace microtrace::io::gltf
