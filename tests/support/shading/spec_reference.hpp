#pragma once
/// The formulas of glTF 2.0, appendix B, and of the material extensions in float64, written from
/// their text and independent of the code under test. The exceptions are the reflectance of thin
/// films and the directional albedo of sheen, which other tests cover.

#include "render/bsdf/parameters.hpp"
#include "render/bsdf/sheen.hpp"
#include "render/bsdf/thin_film.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace microtrace::bsdf {

/// Names are those of the specification: V is the direction to the camera, L to the light, H the
/// half vector. N is +z, with V.z > 0.
class SpecReference {
 public:
  SpecReference(const Parameters& parameters, const Layers& layers, const DVec3& coat_normal)
      : p_(parameters), layers_(layers), nc_(coat_normal) {}

  /// The BSDF times |N.L|, where N is the coat's normal for the coat.
  [[nodiscard]] DVec3 value(const DVec3& v, const DVec3& l) const {
    const double weight = layers_.coat * schlick(DVec3(0.04F), 1, std::abs(dot(v, nc_))).x;
    return glm::mix(under_sheen(v, l) * std::abs(l.z), DVec3(coat(v, l)), weight);
  }

 private:
  static constexpr double kPi = std::numbers::pi;

  static double alpha(double roughness) { return std::max(roughness * roughness, 0.001); }
  static double pow5(double x) { return std::pow(x, 5); }
  static double greatest(const DVec3& c) { return std::max({c.x, c.y, c.z}); }

  // Section B.3.2.
  static double distribution(double a, double n_h) {
    const double q = n_h * n_h * (a * a - 1) + 1;
    return a * a / (kPi * q * q);
  }
  static double g1(double a, double n_w) {
    const double z = std::abs(n_w);
    return 2 * z / (z + std::sqrt(a * a + (1 - a * a) * z * z));
  }
  static double specular_brdf(double a, const DVec3& n, const DVec3& v, const DVec3& l) {
    const double n_v = dot(n, v), n_l = dot(n, l);
    if (n_v <= 0 || n_l <= 0) return 0;
    const DVec3 h = glm::normalize(v + l);
    return distribution(a, dot(n, h)) * g1(a, n_l) * g1(a, n_v) / (4 * n_l * n_v);
  }

  // KHR_materials_anisotropy.
  [[nodiscard]] DVec3 stretched(const DVec3& w, double t, double b) const {
    const DVec3 along = glm::normalize(DVec3(p_.along.x, p_.along.y, 0));
    return {t * dot(along, w), b * dot(DVec3(-along.y, along.x, 0), w), w.z};
  }
  [[nodiscard]] double anisotropic_brdf(const DVec3& v, const DVec3& l) const {
    const double strength = p_.anisotropy, b = alpha(p_.roughness);
    const double t = b + (1 - b) * strength * strength;
    const DVec3 h = stretched(glm::normalize(v + l), 1 / t, 1 / b);
    const double root_v = glm::length(stretched(v, t, b)), root_l = glm::length(stretched(l, t, b));
    return 1 / (kPi * t * b * std::pow(dot(h, h), 2)) * 0.5 / (l.z * root_v + v.z * root_l);
  }
  [[nodiscard]] double specular(const DVec3& v, const DVec3& l) const {
    return p_.anisotropy > 0 ? anisotropic_brdf(v, l)
                             : specular_brdf(alpha(p_.roughness), {0, 0, 1}, v, l);
  }

  // Section B.3.5, KHR_materials_specular and KHR_materials_iridescence. `cosine` is |V.H|.
  static DVec3 schlick(const DVec3& f0, double f90, double cosine) {
    return f0 + (DVec3(f90) - f0) * pow5(1 - cosine);
  }
  [[nodiscard]] DVec3 with_film(const DVec3& f0, double f90, double cosine) const {
    const DVec3 plain = schlick(f0, f90, cosine);
    if (!p_.film) return plain;
    const Vec3 film = thin_film_reflectance<1>(static_cast<float>(cosine), *p_.film, Vec3(f0));
    return glm::mix(plain, DVec3(film), double{p_.film->share});
  }
  /// The dielectric's reflectance for light from V, by the three cases of KHR_materials_volume.
  [[nodiscard]] DVec3 fresnel(double v_h) const {
    const double eta = p_.eta.value_or(1);
    if (eta >= 1) return with_film(p_.dielectric.f0, p_.dielectric.f90, v_h);
    const double square = (1 - v_h * v_h) / (eta * eta);
    if (square >= 1) return DVec3(1);
    return with_film(p_.dielectric.f0, p_.dielectric.f90, std::sqrt(1 - square));
  }

  // KHR_materials_transmission and KHR_materials_volume.
  [[nodiscard]] DVec3 transmitted(const DVec3& v, const DVec3& l) const {
    const double a = alpha(p_.roughness);
    if (!p_.eta) {
      const DVec3 up(l.x, l.y, -l.z), h = glm::normalize(v + up);
      return (1 - greatest(fresnel(dot(v, h)))) * specular(v, up) * DVec3(p_.base_color);
    }
    const double eta = *p_.eta;
    DVec3 h = -glm::normalize(v + eta * l);
    if (h.z < 0) h = -h;
    const double v_h = dot(v, h), l_h = dot(l, h);
    if (v_h <= 0 || l_h >= 0) return DVec3(0);
    const double btdf = std::abs(l_h * v_h / (l.z * v.z)) * eta * eta * g1(a, l.z) * g1(a, v.z) *
                        distribution(a, h.z) / std::pow(v_h + eta * l_h, 2);
    return (1 - greatest(fresnel(v_h))) * btdf * DVec3(p_.base_color);
  }

  // Section B.2 with KHR_materials_diffuse_transmission.
  [[nodiscard]] DVec3 material(const DVec3& v, const DVec3& l) const {
    const double t = p_.transmission, dt = p_.diffuse_transmission;
    const DVec3 h = glm::normalize(v + DVec3(l.x, l.y, std::abs(l.z)));
    // The diffuse part is not visible from inside.
    const double left = p_.eta.value_or(1) < 1 ? 0 : 1 - greatest(fresnel(dot(v, h)));
    const DVec3 color =
        l.z > 0 ? (1 - dt) * DVec3(p_.base_color) : dt * DVec3(p_.diffuse_transmission_color);
    DVec3 dielectric = left * (1 - t) / kPi * color;
    if (l.z < 0) return (1 - double{p_.metallic}) * (dielectric + t * transmitted(v, l));
    dielectric += fresnel(dot(v, h)) * specular(v, l);
    const DVec3 metal = with_film(p_.base_color, 1, dot(v, h)) * specular(v, l);
    return glm::mix(dielectric, metal, double{p_.metallic});
  }

  // KHR_materials_sheen.
  static double lambda(double z, double a) {
    const double t = (1 - a) * (1 - a);
    const auto l = [&](double x) {
      return glm::mix(21.5473, 25.3245, t) /
                 (1 + glm::mix(3.82987, 3.32435, t) * std::pow(x, glm::mix(0.19823, 0.16801, t))) +
             glm::mix(-1.97760, -1.27393, t) * x + glm::mix(-4.32054, -4.85967, t);
    };
    return std::exp(z < 0.5 ? l(z) : 2 * l(0.5) - l(1 - z));
  }
  [[nodiscard]] DVec3 under_sheen(const DVec3& v, const DVec3& l) const {
    const DVec3 color = layers_.sheen, base = material(v, l);
    if (color == DVec3(0)) return base;
    const SheenLobe<1> lobe(layers_.sheen_roughness);
    const auto scale = [&](double z) {
      return 1 - greatest(color) * lobe.albedo(static_cast<float>(std::abs(z)));
    };
    const DVec3 scaled = base * std::min(scale(v.z), scale(l.z));
    if (l.z < 0) return scaled;
    const double r = std::max(layers_.sheen_roughness, kLeastSheenRoughness), a = r * r;
    const DVec3 h = glm::normalize(v + l);
    const double d = (2 + 1 / a) * std::pow(1 - h.z * h.z, 0.5 / a) / (2 * kPi);
    return scaled + color * d / ((1 + lambda(v.z, a) + lambda(l.z, a)) * 4 * v.z * l.z);
  }

  // KHR_materials_clearcoat. Transmitting surfaces have the light of both sides on one side each.
  [[nodiscard]] double coat(const DVec3& v, const DVec3& l) const {
    const bool transmits = p_.transmission > 0 || p_.diffuse_transmission > 0;
    if (transmits && l.z <= 0) return 0;
    return specular_brdf(alpha(layers_.coat_roughness), nc_, v, l) * dot(nc_, l);
  }

  Parameters p_;
  Layers layers_;
  DVec3 nc_;
};

}  // namespace microtrace::bsdf
