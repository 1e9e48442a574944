#pragma once
/// Lists the attributes of Python's dataclasses with the corresponding members of the library's
/// structs. Conversions in both directions use these lists.

#include <microtrace/microtrace.hpp>

#include <array>
#include <cstddef>
#include <tuple>

namespace microtrace::python {

/// Python's names for the values of an enumeration, in the order of the values. Specialized for
/// each enumeration.
template <class Enum>
inline constexpr std::array<const char*, 0> kNames{};
template <>
inline constexpr auto kNames<AlphaMode> = std::array{"opaque", "mask", "blend"};
template <>
inline constexpr auto kNames<Wrap> = std::array{"repeat", "mirrored_repeat", "clamp_to_edge"};
template <>
inline constexpr auto kNames<Filter> = std::array{"nearest", "linear"};
template <>
inline constexpr auto kNames<MipFilter> = std::array{"none", "nearest", "linear"};

/// An attribute of a Python object and the member of T that holds its value. The library's errors
/// name the member, by `member_name`.
template <class T, class Member>
struct Field {
  const char* name;
  Member T::*member;
  const char* member_name = name;
};
template <class T, class Member>
Field(const char*, Member T::*) -> Field<T, Member>;
template <class T, class Member>
Field(const char*, Member T::*, const char*) -> Field<T, Member>;

/// Specialized for each struct, with the module kModule and the name kName of the Python class, and
/// the list kFields.
template <class T>
struct Class;

template <>
struct Class<Specular> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Specular";
  static constexpr auto kFields =
      std::tuple(Field{"specular_factor", &Specular::factor, "factor"},
                 Field{"specular_texture", &Specular::texture, "texture"},
                 Field{"specular_color_factor", &Specular::color, "color"},
                 Field{"specular_color_texture", &Specular::color_texture, "color_texture"});
};

template <>
struct Class<Transmission> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Transmission";
  static constexpr auto kFields =
      std::tuple(Field{"transmission_factor", &Transmission::factor, "factor"},
                 Field{"transmission_texture", &Transmission::texture, "texture"});
};

template <>
struct Class<Volume> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Volume";
  static constexpr auto kFields =
      std::tuple(Field{"thickness_factor", &Volume::thickness, "thickness"},
                 Field{"thickness_texture", &Volume::texture, "texture"},
                 Field{"attenuation_distance", &Volume::attenuation_distance},
                 Field{"attenuation_color", &Volume::attenuation_color});
};

template <>
struct Class<VolumeScatter> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "VolumeScatter";
  static constexpr auto kFields =
      std::tuple(Field{"multiscatter_color", &VolumeScatter::multiscatter_color},
                 Field{"scatter_anisotropy", &VolumeScatter::anisotropy, "anisotropy"});
};

template <>
struct Class<Clearcoat> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Clearcoat";
  static constexpr auto kFields = std::tuple(
      Field{"clearcoat_factor", &Clearcoat::factor, "factor"},
      Field{"clearcoat_roughness_factor", &Clearcoat::roughness, "roughness"},
      Field{"clearcoat_texture", &Clearcoat::texture, "texture"},
      Field{"clearcoat_roughness_texture", &Clearcoat::roughness_texture, "roughness_texture"},
      Field{"clearcoat_normal_texture", &Clearcoat::normal_texture, "normal_texture"},
      Field{"clearcoat_normal_scale", &Clearcoat::normal_scale, "normal_scale"});
};

template <>
struct Class<Sheen> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Sheen";
  static constexpr auto kFields =
      std::tuple(Field{"sheen_color_factor", &Sheen::color, "color"},
                 Field{"sheen_roughness_factor", &Sheen::roughness, "roughness"},
                 Field{"sheen_color_texture", &Sheen::color_texture, "color_texture"},
                 Field{"sheen_roughness_texture", &Sheen::roughness_texture, "roughness_texture"});
};

template <>
struct Class<Anisotropy> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Anisotropy";
  static constexpr auto kFields =
      std::tuple(Field{"anisotropy_strength", &Anisotropy::strength, "strength"},
                 Field{"anisotropy_rotation", &Anisotropy::rotation, "rotation"},
                 Field{"anisotropy_texture", &Anisotropy::texture, "texture"});
};

template <>
struct Class<Iridescence> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Iridescence";
  static constexpr auto kFields = std::tuple(
      Field{"iridescence_factor", &Iridescence::factor, "factor"},
      Field{"iridescence_ior", &Iridescence::ior, "ior"},
      Field{"iridescence_thickness_minimum", &Iridescence::thickness_minimum, "thickness_minimum"},
      Field{"iridescence_thickness_maximum", &Iridescence::thickness_maximum, "thickness_maximum"},
      Field{"iridescence_texture", &Iridescence::texture, "texture"},
      Field{"iridescence_thickness_texture", &Iridescence::thickness_texture, "thickness_texture"});
};

template <>
struct Class<DiffuseTransmission> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "DiffuseTransmission";
  static constexpr auto kFields =
      std::tuple(Field{"diffuse_transmission_factor", &DiffuseTransmission::factor, "factor"},
                 Field{"diffuse_transmission_texture", &DiffuseTransmission::texture, "texture"},
                 Field{"diffuse_transmission_color_factor", &DiffuseTransmission::color, "color"},
                 Field{"diffuse_transmission_color_texture", &DiffuseTransmission::color_texture,
                       "color_texture"});
};

template <>
struct Class<SpecularGlossiness> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "SpecularGlossiness";
  static constexpr auto kFields =
      std::tuple(Field{"specular_factor", &SpecularGlossiness::specular, "specular"},
                 Field{"glossiness_factor", &SpecularGlossiness::glossiness, "glossiness"},
                 Field{"specular_glossiness_texture", &SpecularGlossiness::texture, "texture"});
};

template <>
struct Class<Material> {
  static constexpr const char* kModule = "materials";
  static constexpr const char* kName = "Material";
  static constexpr auto kFields = std::tuple(
      Field{"name", &Material::name},
      Field{"base_color_factor", &Material::base_color, "base_color"},
      Field{"base_color_texture", &Material::base_color_texture},
      Field{"alpha_mode", &Material::alpha_mode}, Field{"alpha_cutoff", &Material::alpha_cutoff},
      Field{"double_sided", &Material::double_sided}, Field{"unlit", &Material::unlit},
      Field{"metallic_factor", &Material::metallic, "metallic"},
      Field{"roughness_factor", &Material::roughness, "roughness"},
      Field{"metallic_roughness_texture", &Material::metallic_roughness_texture},
      Field{"normal_texture", &Material::normal_texture},
      Field{"normal_scale", &Material::normal_scale},
      Field{"occlusion_texture", &Material::occlusion_texture},
      Field{"occlusion_strength", &Material::occlusion_strength},
      Field{"emissive_factor", &Material::emissive, "emissive"},
      Field{"emissive_texture", &Material::emissive_texture}, Field{"ior", &Material::ior},
      Field{"dispersion", &Material::dispersion}, Field{"specular", &Material::specular},
      Field{"transmission", &Material::transmission}, Field{"volume", &Material::volume},
      Field{"volume_scatter", &Material::volume_scatter}, Field{"clearcoat", &Material::clearcoat},
      Field{"sheen", &Material::sheen}, Field{"anisotropy", &Material::anisotropy},
      Field{"iridescence", &Material::iridescence},
      Field{"diffuse_transmission", &Material::diffuse_transmission},
      Field{"specular_glossiness", &Material::specular_glossiness});
};

template <>
struct Class<DirectionalLight> {
  static constexpr const char* kModule = "lights";
  static constexpr const char* kName = "DirectionalLight";
  static constexpr auto kFields = std::tuple(Field{"direction", &DirectionalLight::direction},
                                             Field{"color", &DirectionalLight::color},
                                             Field{"intensity", &DirectionalLight::intensity});
};

template <>
struct Class<PointLight> {
  static constexpr const char* kModule = "lights";
  static constexpr const char* kName = "PointLight";
  static constexpr auto kFields =
      std::tuple(Field{"position", &PointLight::position}, Field{"color", &PointLight::color},
                 Field{"intensity", &PointLight::intensity}, Field{"range", &PointLight::range});
};

template <>
struct Class<SpotLight> {
  static constexpr const char* kModule = "lights";
  static constexpr const char* kName = "SpotLight";
  static constexpr auto kFields =
      std::tuple(Field{"position", &SpotLight::position}, Field{"direction", &SpotLight::direction},
                 Field{"color", &SpotLight::color}, Field{"intensity", &SpotLight::intensity},
                 Field{"range", &SpotLight::range},
                 Field{"inner_cone_angle", &SpotLight::inner_angle, "inner_angle"},
                 Field{"outer_cone_angle", &SpotLight::outer_angle, "outer_angle"});
};

template <>
struct Class<Sphere> {
  static constexpr const char* kModule = "shapes";
  static constexpr const char* kName = "Sphere";
  static constexpr auto kFields =
      std::tuple(Field{"center", &Sphere::center}, Field{"radius", &Sphere::radius});
};

template <>
struct Class<Plane> {
  static constexpr const char* kModule = "shapes";
  static constexpr const char* kName = "Plane";
  static constexpr auto kFields =
      std::tuple(Field{"point", &Plane::point}, Field{"normal", &Plane::normal});
};

template <>
struct Class<Disc> {
  static constexpr const char* kModule = "shapes";
  static constexpr const char* kName = "Disc";
  static constexpr auto kFields =
      std::tuple(Field{"center", &Disc::center}, Field{"normal", &Disc::normal},
                 Field{"radius", &Disc::radius});
};

template <>
struct Class<Triangle> {
  static constexpr const char* kModule = "shapes";
  static constexpr const char* kName = "Triangle";
  static constexpr auto kFields =
      std::tuple(Field{"a", &Triangle::a}, Field{"b", &Triangle::b}, Field{"c", &Triangle::c});
};

template <>
struct Class<Mesh> {
  static constexpr const char* kModule = "shapes";
  static constexpr const char* kName = "Mesh";
  static constexpr auto kFields =
      std::tuple(Field{"vertices", &Mesh::positions, "positions"},
                 Field{"faces", &Mesh::triangles, "triangles"}, Field{"normals", &Mesh::normals},
                 Field{"tangents", &Mesh::tangents}, Field{"uv", &Mesh::uv_sets, "uv_sets"},
                 Field{"colors", &Mesh::colors}, Field{"segments", &Mesh::segments});
};

template <>
struct Class<Pose> {
  static constexpr auto kFields =
      std::tuple(Field{"position", &Pose::position}, Field{"direction", &Pose::direction},
                 Field{"up", &Pose::up});
};

template <>
struct Class<DepthRange> {
  static constexpr auto kFields =
      std::tuple(Field{"near", &DepthRange::near}, Field{"far", &DepthRange::far});
};

template <>
struct Class<PerspectiveCamera> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "PerspectiveCamera";
  static constexpr auto kFields =
      std::tuple(Field{"vertical_fov", &PerspectiveCamera::vertical_fov},
                 Field{"aspect_ratio", &PerspectiveCamera::aspect_ratio},
                 Field{"focus", &PerspectiveCamera::focus},
                 Field{"lens_radius", &PerspectiveCamera::lens_radius});
};

template <>
struct Class<OrthographicCamera> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "OrthographicCamera";
  static constexpr auto kFields =
      std::tuple(Field{"height", &OrthographicCamera::height},
                 Field{"aspect_ratio", &OrthographicCamera::aspect_ratio});
};

template <>
struct Class<EnvironmentCamera> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "EnvironmentCamera";
  static constexpr auto kFields = std::tuple();
};

template <>
struct Class<RationalDistortion> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "RationalDistortion";
  static constexpr auto kFields =
      std::tuple(Field{"k1", &RationalDistortion::k1}, Field{"k2", &RationalDistortion::k2},
                 Field{"p1", &RationalDistortion::p1}, Field{"p2", &RationalDistortion::p2},
                 Field{"k3", &RationalDistortion::k3}, Field{"k4", &RationalDistortion::k4},
                 Field{"k5", &RationalDistortion::k5}, Field{"k6", &RationalDistortion::k6});
};

template <>
struct Class<FisheyeDistortion> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "FisheyeDistortion";
  static constexpr auto kFields =
      std::tuple(Field{"k1", &FisheyeDistortion::k1}, Field{"k2", &FisheyeDistortion::k2},
                 Field{"k3", &FisheyeDistortion::k3}, Field{"k4", &FisheyeDistortion::k4});
};

template <>
struct Class<CalibratedCamera> {
  static constexpr const char* kModule = "cameras";
  static constexpr const char* kName = "CalibratedCamera";
  static constexpr auto kFields = std::tuple(
      Field{"image_size", &CalibratedCamera::image, "image"}, Field{"fx", &CalibratedCamera::fx},
      Field{"fy", &CalibratedCamera::fy}, Field{"cx", &CalibratedCamera::cx},
      Field{"cy", &CalibratedCamera::cy}, Field{"distortion", &CalibratedCamera::distortion});
};

/// Calls f(name, member) for all fields of a struct.
template <class T, class F>
void for_each_field(T& value, const F& f) {
  std::apply([&](const auto&... field) { (f(field.name, value.*field.member), ...); },
             Class<std::remove_const_t<T>>::kFields);
}

}  // namespace microtrace::python
