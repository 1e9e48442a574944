#include "io/scene_json/material.hpp"

#include <string_view>

namespace microtrace::io {
namespace {

/// Reads optional members of an object.
class Members {
 public:
  Members(const JsonReader& json, const Colors& colors) : json_(json), colors_(colors) {}

  void share(std::string_view key, float& out) const {
    if (const auto member = json_.find(key)) out = read_share(*member);
  }
  void at_least(std::string_view key, double least, float& out) const {
    if (const auto member = json_.find(key)) out = read_at_least(*member, least);
  }
  void in_range(std::string_view key, double least, double most, float& out) const {
    if (const auto member = json_.find(key)) out = read_in_range(*member, least, most);
  }
  void positive(std::string_view key, float& out) const {
    if (const auto member = json_.find(key)) out = read_positive(*member);
  }
  void boolean(std::string_view key, bool& out) const {
    if (const auto member = json_.find(key)) out = read_boolean(*member);
  }
  void color(std::string_view key, Vec3& out, double most = 1) const {
    if (const auto member = json_.find(key)) out = read_color(*member, colors_, most);
  }

 private:
  const JsonReader& json_;
  const Colors& colors_;
};

/// Reads an index of refraction, for which 0 means infinity (KHR_materials_ior).
float read_ior(const JsonReader& json) {
  const double ior = json.number();
  if (ior == 0 || ior >= 1) return static_cast<float>(ior);
  json.fail("must be at least 1, or 0 for infinity, is " + decimal(ior));
}

Specular read_specular(const JsonReader& json, const Colors& colors) {
  json.require_object({"factor", "color"});
  const Members members(json, colors);
  Specular result;
  members.share("factor", result.factor);
  members.color("color", result.color, kMaxRadiance);
  return result;
}

Volume read_volume(const JsonReader& json, const Colors& colors) {
  json.require_object({"attenuation_distance", "attenuation_color"});
  const Members members(json, colors);
  Volume result{.thickness = 1};
  members.positive("attenuation_distance", result.attenuation_distance);
  members.color("attenuation_color", result.attenuation_color);
  return result;
}

VolumeScatter read_volume_scatter(const JsonReader& json, const Colors& colors) {
  json.require_object({"multiscatter_color", "anisotropy"});
  const Members members(json, colors);
  VolumeScatter result{.multiscatter_color = Vec3(1)};
  members.color("multiscatter_color", result.multiscatter_color);
  members.in_range("anisotropy", -1, 1, result.anisotropy);
  return result;
}

Clearcoat read_clearcoat(const JsonReader& json, const Colors& colors) {
  json.require_object({"factor", "roughness"});
  const Members members(json, colors);
  Clearcoat result{.factor = 1};
  members.share("factor", result.factor);
  members.share("roughness", result.roughness);
  return result;
}

Sheen read_sheen(const JsonReader& json, const Colors& colors) {
  json.require_object({"color", "roughness"});
  const Members members(json, colors);
  Sheen result{.color = Vec3(1)};
  members.color("color", result.color);
  members.share("roughness", result.roughness);
  return result;
}

Iridescence read_iridescence(const JsonReader& json, const Colors& colors) {
  json.require_object({"factor", "ior", "thickness"});
  const Members members(json, colors);
  Iridescence result{.factor = 1};
  members.share("factor", result.factor);
  members.at_least("ior", 1, result.ior);
  members.at_least("thickness", 0, result.thickness_maximum);
  return result;
}

DiffuseTransmission read_diffuse_transmission(const JsonReader& json, const Colors& colors) {
  json.require_object({"factor", "color"});
  const Members members(json, colors);
  DiffuseTransmission result{.factor = 1};
  members.share("factor", result.factor);
  members.color("color", result.color);
  return result;
}

}  // namespace

Material read_material(const JsonReader& json, const Colors& colors) {
  json.require_object({"base_color", "double_sided", "unlit", "metallic", "roughness", "emissive",
                       "ior", "dispersion", "specular", "transmission", "volume", "volume_scatter",
                       "clearcoat", "sheen", "iridescence", "diffuse_transmission"});
  const Members members(json, colors);
  Material result;
  Vec3 base_color(1);
  members.color("base_color", base_color);
  result.base_color = Vec4(base_color, 1);
  members.boolean("double_sided", result.double_sided);
  members.boolean("unlit", result.unlit);
  members.share("metallic", result.metallic);
  members.share("roughness", result.roughness);
  members.color("emissive", result.emissive, kMaxRadiance);
  if (const auto ior = json.find("ior")) result.ior = read_ior(*ior);
  members.at_least("dispersion", 0, result.dispersion);
  if (const auto transmission = json.find("transmission")) {
    result.transmission = Transmission{.factor = read_share(*transmission)};
  }
  if (const auto own = json.find("specular")) result.specular = read_specular(*own, colors);
  if (const auto own = json.find("volume")) result.volume = read_volume(*own, colors);
  if (const auto own = json.find("volume_scatter")) {
    result.volume_scatter = read_volume_scatter(*own, colors);
  }
  if (const auto own = json.find("clearcoat")) result.clearcoat = read_clearcoat(*own, colors);
  if (const auto own = json.find("sheen")) result.sheen = read_sheen(*own, colors);
  if (const auto own = json.find("iridescence")) {
    result.iridescence = read_iridescence(*own, colors);
  }
  if (const auto own = json.find("diffuse_transmission")) {
    result.diffuse_transmission = read_diffuse_transmission(*own, colors);
  }
  return result;
}

}  // namespace microtrace::io
