#pragma once
/// Lists the attributes of Python's dataclasses with the corresponding members of the library's
/// structs. Conversions in both directions use these lists.

#include "field.hpp"
#include "material_fields.hpp"

#include <microtrace/microtrace.hpp>

#include <array>
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

}  // namespace microtrace::python
