#include "scene/validate/numbers.hpp"

#include <numbers>

namespace microtrace {
namespace {

using Rule = std::optional<BrokenRule>;

template <class T>
Rule fraction(const char* field, const T& x) {
  return in_range(field, x, 0, 1);
}

Rule check(const Specular& s) {
  return first_of({fraction("specular/factor", s.factor), at_least("specular/color", s.color, 0)});
}
Rule check(const Transmission& t) {
  return fraction("transmission/factor", t.factor);
}
Rule check(const Volume& v) {
  return first_of({at_least("volume/thickness", v.thickness, 0),
                   v.attenuation_distance > 0
                       ? Rule{}
                       : broken_rule("volume/attenuation_distance", "must be positive"),
                   fraction("volume/attenuation_color", v.attenuation_color)});
}
Rule check(const VolumeScatter& v) {
  return first_of({fraction("volume_scatter/multiscatter_color", v.multiscatter_color),
                   in_range("volume_scatter/anisotropy", v.anisotropy, -1, 1)});
}
Rule check(const Clearcoat& c) {
  return first_of({fraction("clearcoat/factor", c.factor),
                   fraction("clearcoat/roughness", c.roughness),
                   in_range("clearcoat/normal_scale", c.normal_scale, -1e6, 1e6)});
}
Rule check(const Sheen& s) {
  return first_of({fraction("sheen/color", s.color), fraction("sheen/roughness", s.roughness)});
}
Rule check(const Anisotropy& a) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return first_of({fraction("anisotropy/strength", a.strength),
                   in_range("anisotropy/rotation", a.rotation, -kTurn, kTurn)});
}
Rule check(const Iridescence& i) {
  return first_of({fraction("iridescence/factor", i.factor), at_least("iridescence/ior", i.ior, 1),
                   at_least("iridescence/thickness_minimum", i.thickness_minimum, 0),
                   at_least("iridescence/thickness_maximum", i.thickness_maximum, 0)});
}
Rule check(const DiffuseTransmission& d) {
  return first_of({fraction("diffuse_transmission/factor", d.factor),
                   fraction("diffuse_transmission/color", d.color)});
}
Rule check(const SpecularGlossiness& s) {
  return first_of({fraction("specular_glossiness/specular", s.specular),
                   fraction("specular_glossiness/glossiness", s.glossiness)});
}

template <class T>
Rule check(const std::optional<T>& part) {
  return part ? check(*part) : Rule{};
}

}  // namespace

Rule validate(const Material& m) {
  return first_of(
      {fraction("base_color", m.base_color), at_least("alpha_cutoff", m.alpha_cutoff, 0),
       fraction("metallic", m.metallic), fraction("roughness", m.roughness),
       in_range("normal_scale", m.normal_scale, -1e6, 1e6),
       fraction("occlusion_strength", m.occlusion_strength), at_least("emissive", m.emissive, 0),
       m.ior == 0 ? Rule{} : at_least("ior", m.ior, 1), at_least("dispersion", m.dispersion, 0),
       check(m.specular), check(m.transmission), check(m.volume), check(m.volume_scatter),
       check(m.clearcoat), check(m.sheen), check(m.anisotropy), check(m.iridescence),
       check(m.diffuse_transmission), check(m.specular_glossiness)});
}

}  // namespace microtrace
