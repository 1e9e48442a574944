#pragma once
/// A scene as the loaders make it: plain data, checked by `validate`.

#include <microtrace/camera.hpp>
#include <microtrace/hit.hpp>
#include <microtrace/shape.hpp>

#include <string>
#include <vector>

namespace microtrace {

/// Something to draw, in one constant colour.
struct Object {
  std::string name;
  Shape shape;
  Vec3 color{1};  ///< linear Rec. 709, each in [0, 1]
};

struct NamedCamera {
  std::string name;
  Camera camera;
};

struct Scene {
  std::vector<Object> objects;
  std::vector<NamedCamera> cameras;  ///< at least one once loaded
  ImageSize size;                    ///< of the picture, unless the caller wants another
  Vec3 background{0};                ///< linear Rec. 709
  float epsilon = 0;  ///< primary rays hit only in the open interval (epsilon, infinity)
};

/// How many PrimitiveIds a shape takes.
[[nodiscard]] std::size_t primitive_count(const Shape& shape);

}  // namespace microtrace
