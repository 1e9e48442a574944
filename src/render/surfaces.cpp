#include "render/surfaces.hpp"

#include "scene/surface_interaction.hpp"

#include <algorithm>

namespace microtrace {

Surfaces::Surfaces(const Scene& scene, const Primitives& primitives)
    : scene_(scene), primitives_(primitives) {
  entries_.reserve(scene.objects.size());
  for (const Object& object : scene.objects) {
    const Material& material = material_of(scene, object);
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    Entry entry{.color = Vec3(material.base_color), .kind = Kind::plain};
    if (material.alpha_mode != AlphaMode::opaque || material.base_color_texture ||
        (mesh != nullptr && !mesh->colors.empty())) {
      entry.kind = Kind::various;
    } else if (!material.double_sided) {
      entry.kind = Kind::one_sided;
    }
    entries_.push_back(entry);
  }
}

bool Surfaces::is_front(const Ray& ray, const Hit& hit) const {
  return primitives_.visit(hit.id, [&](const auto& shape) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, Triangle>) {
      return shows_front(shape, ray.d);
    } else {
      return interact(primitives_, ray, hit).front;
    }
  });
}

Vec4 Surfaces::base_color(const Material& material, const SurfaceInteraction& at) const {
  return Vec4(DVec4(material.base_color) * at.color());
}

Vec4 Surfaces::look(const Ray& ray, const Hit& hit) const {
  const Material& material = material_of(scene_, primitives_.object(hit.id));
  const SurfaceInteraction at = interact(primitives_, ray, hit);
  if (!at.front && !material.double_sided) return Vec4(0);
  Vec4 color = base_color(material, at);
  switch (material.alpha_mode) {
    case AlphaMode::opaque:
      color.w = 1;
      break;
    case AlphaMode::mask:
      color.w = color.w >= material.alpha_cutoff ? 1 : 0;
      break;
    case AlphaMode::blend:
      color.w = std::clamp(color.w, 0.0F, 1.0F);
      break;
  }
  return color;
}

bool Surfaces::is_same_point(const Ray& ray, const Hit& a, const Hit& b) const {
  const std::size_t object = primitives_.object_index(a.id);
  if (a.t != b.t || object != primitives_.object_index(b.id)) return false;
  const auto* mesh = std::get_if<Mesh>(&scene_.objects[object].shape);
  if (mesh == nullptr) return false;
  const PrimitiveId first = primitives_.first_id(a.id);
  const Triangle one = triangle_of(*mesh, a.id - first), other = triangle_of(*mesh, b.id - first);
  // By place: at seams of texture coordinates vertices of different numbers meet.
  const auto is_corner = [&other](const Vec3& p) {
    return p == other.a || p == other.b || p == other.c;
  };
  return (is_corner(one.a) || is_corner(one.b) || is_corner(one.c)) &&
         shows_front(one, ray.d) == shows_front(other, ray.d);
}

std::optional<Hit> Surfaces::first_seen(const Bvh& bvh, const Ray& ray,
                                        std::optional<Hit> hit) const {
  while (hit && !plain_look(ray, *hit) && look(ray, *hit).w <= 0) hit = bvh.next(ray, *hit);
  return hit;
}

}  // namespace microtrace
