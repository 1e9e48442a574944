#pragma once
/// Bodies that contain a medium, and what a camera sees of them.

#include "support/pictures.hpp"

#include <microtrace/material.hpp>
#include <microtrace/scene.hpp>

#include <cstdint>

namespace microtrace {

/// The number of pictures whose mean is compared.
inline constexpr std::uint32_t kSeeds = 12;
/// The error of a mean of kSeeds estimates exceeds this multiple of its standard deviation once in
/// 10 000 times (Student's t, 11 degrees of freedom).
inline constexpr double kFar = 5.8;

/// A surface that reflects nothing by itself, around a medium that absorbs this color's complement
/// per length 1.
[[nodiscard]] inline Material boundary(const Vec3& attenuation_color) {
  Material m{.roughness = 0};
  m.specular = Specular{.factor = 0};
  m.volume = Volume{.thickness = 1, .attenuation_distance = 1};
  m.volume->attenuation_color = attenuation_color;
  return m;
}

/// Light enters and leaves the body in all directions.
[[nodiscard]] inline Material diffuse_body(const Vec3& attenuation_color) {
  Material m = boundary(attenuation_color);
  m.diffuse_transmission = DiffuseTransmission{.factor = 1};
  return m;
}

/// Light crosses the surface without a change of its direction.
[[nodiscard]] inline Material clear_body(const Vec3& attenuation_color) {
  Material m = boundary(attenuation_color);
  m.ior = 1;
  m.transmission = Transmission{.factor = 1};
  return m;
}

/// A ball of radius 1 in front of a camera that sees only the ball, under uniform white light.
[[nodiscard]] inline Scene ball_under_sky(const Material& material) {
  Scene scene;
  scene.materials = {material};
  scene.objects.push_back({.name = "ball", .shape = Sphere{{0, 0, 0}, 1}, .material = 0});
  scene.environment = Environment{.content = Vec3(1)};
  return scene;
}
inline const OrthographicCamera kAcrossBall{
    .pose = {.position = {0, 0, 3}, .direction = {0, 0, -1}, .up = {0, 1, 0}}, .height = 1.4};

[[nodiscard]] inline Material scattering(Material body, const Vec3& color, float anisotropy = 0) {
  body.volume_scatter = VolumeScatter{.multiscatter_color = color, .anisotropy = anisotropy};
  return body;
}

/// Light is refracted at the surface.
[[nodiscard]] inline Material glass_body(const Vec3& attenuation_color, float roughness) {
  Material m{.roughness = roughness};
  m.transmission = Transmission{.factor = 1};
  m.volume = clear_body(attenuation_color).volume;
  return m;
}

}  // namespace microtrace
