#include "scene/validate/numbers.hpp"

#include <algorithm>
#include <numbers>
#include <variant>

namespace microtrace {
namespace {

using Rule = std::optional<BrokenRule>;

Rule check_radiance(const char* field, const Vec3& radiance) {
  return in_range(field, radiance, 0, kMaxRadiance);
}

/// Checks the pixels of a map, if the environment has one.
Rule check_pixels(const Environment& environment) {
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map == nullptr) return {};
  const auto is_valid = [](const Vec3& p) {
    const auto is_in_range = [](float x) { return 0 <= x && x <= kMaxRadiance; };
    return is_in_range(p.x) && is_in_range(p.y) && is_in_range(p.z);
  };
  const auto& pixels = (*map)->pixels;
  const auto broken = std::find_if_not(pixels.begin(), pixels.end(), is_valid);
  return broken == pixels.end() ? Rule{} : check_radiance("content", *broken);
}

}  // namespace

Rule validate(const Light& light) {
  return std::visit(
      []<class T>(const T& l) {
        Rule rule =
            first_of({at_least("color", l.color, 0), at_least("intensity", l.intensity, 0)});
        if constexpr (requires { l.direction; })
          rule = first_of({rule, in_range("direction", l.direction, -1.001, 1.001)});
        if constexpr (requires { l.position; })
          rule = first_of({rule, in_range("position", l.position, -kFloat32Bound, kFloat32Bound),
                           l.range > 0 ? Rule{} : broken_rule("range", "must be positive")});
        if constexpr (requires { l.inner_angle; }) {
          const bool is_cone = 0 <= l.inner_angle && l.inner_angle < l.outer_angle &&
                               l.outer_angle <= std::numbers::pi / 2;
          rule = first_of({rule, is_cone ? Rule{}
                                         : broken_rule("outer_angle",
                                                       "must be above inner_angle, which must not "
                                                       "be negative, and at most pi / 2")});
        }
        return rule;
      },
      light);
}

Rule validate(const Environment& environment) {
  const auto* radiance = std::get_if<Vec3>(&environment.content);
  return first_of(
      {radiance != nullptr ? check_radiance("content", *radiance) : check_pixels(environment),
       in_range("rotation", environment.rotation, -1e6, 1e6),
       at_least("intensity", environment.intensity, 0)});
}

}  // namespace microtrace
