#pragma once
/// The scene as plain data. Loaders create scenes, and validate() checks them.

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/light.hpp>
#include <microtrace/material.hpp>
#include <microtrace/objects.hpp>
#include <microtrace/shape.hpp>
#include <microtrace/texture.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace {

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct NamedLight {
  std::string name;
  Light light;
};

struct Scene {
  /// World space is the coordinate system of the scene file. All coordinates in the scene are scene
  /// coordinates: world space translated so that this position becomes (0, 0, 0). Loaders translate
  /// scenes that are far from the file's origin, because float32 is most precise near zero.
  DVec3 origin{0};
  Objects objects;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::shared_ptr<const Image>> images;  ///< null if the image was not decoded
  std::vector<NamedCamera> cameras;                  ///< if empty, see default_camera
  std::vector<NamedLight> lights{};
  std::optional<Environment> environment{};  ///< has no effect on flat pictures
  ImageSize size;                            ///< default size of the picture
  Vec3 background{0};                        ///< linear Rec. 709
  float epsilon = 0;  ///< camera rays hit only at t in the open interval (epsilon, infinity)
};

/// Returns the object's material; the reference is valid for the lifetime of the scene.
[[nodiscard]] MICROTRACE_EXPORT const Material& material_of(const Scene& scene,
                                                            const Object& object);

/// Returns the number of PrimitiveIds that a shape has.
[[nodiscard]] MICROTRACE_EXPORT std::size_t primitive_count(const Shape& shape);
/// Returns the number of PrimitiveIds that all objects of a run have.
[[nodiscard]] MICROTRACE_EXPORT std::size_t primitive_count(const ObjectRun& run);

}  // namespace microtrace
