#pragma once
/// A scene as created by the loaders: plain data, checked by `validate`.

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/export.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/light.hpp>
#include <microtrace/material.hpp>
#include <microtrace/shape.hpp>
#include <microtrace/texture.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace microtrace {

/// A shape with one material.
struct Object {
  std::string name;
  Shape shape;
  std::optional<std::uint32_t> material{};  ///< index into Scene::materials; nothing: Material{}
};

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct NamedLight {
  std::string name;
  Light light;
};

struct Scene {
  /// The position of these coordinates' (0, 0, 0) in the file's own coordinates. Scenes far from
  /// the file's origin are translated, so that float32 can represent them precisely.
  DVec3 origin{0};
  std::vector<Object> objects;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::shared_ptr<const Image>> images;  ///< null if not decoded
  std::vector<NamedCamera> cameras;                  ///< if empty, see default_camera
  std::vector<NamedLight> lights{};
  std::optional<Environment> environment{};  ///< no effect on flat pictures
  ImageSize size;                            ///< default size of the picture
  Vec3 background{0};                        ///< linear Rec. 709
  float epsilon = 0;  ///< camera rays only hit in the open interval (epsilon, infinity)
};

/// The object's material, valid for the lifetime of the scene.
[[nodiscard]] MICROTRACE_EXPORT const Material& material_of(const Scene& scene,
                                                            const Object& object);

/// The number of a shape's PrimitiveIds.
[[nodiscard]] MICROTRACE_EXPORT std::size_t primitive_count(const Shape& shape);

}  // namespace microtrace
