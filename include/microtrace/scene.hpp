#pragma once
/// A scene as the loaders make it: plain data, checked by `validate`.

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

/// Something to draw, of one material.
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
  /// Where (0, 0, 0) of all coordinates here lies in the world that the file speaks of: next to a
  /// scene that is far from that world's own origin, so that float32 can hold it.
  DVec3 origin{0};
  std::vector<Object> objects;
  std::vector<Material> materials;
  std::vector<Texture> textures;
  std::vector<std::shared_ptr<const Image>> images;  ///< null where one was not decoded
  std::vector<NamedCamera> cameras;                  ///< none: see default_camera
  std::vector<NamedLight> lights{};
  std::optional<Environment> environment{};  ///< has no influence on flat pictures
  ImageSize size;                            ///< of the picture, unless the caller wants another
  Vec3 background{0};                        ///< linear Rec. 709
  float epsilon = 0;  ///< primary rays hit only in the open interval (epsilon, infinity)
};

/// The object's material, which lives as long as the scene.
[[nodiscard]] MICROTRACE_EXPORT const Material& material_of(const Scene& scene,
                                                            const Object& object);

/// How many PrimitiveIds a shape takes.
[[nodiscard]] MICROTRACE_EXPORT std::size_t primitive_count(const Shape& shape);

}  // namespace microtrace
