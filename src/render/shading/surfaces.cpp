#include "render/shading/surfaces.hpp"

#include "accel/resolve/exact_hits.hpp"
#include "render/textures/shared_textures.hpp"

#include <microtrace/integrator.hpp>
#include <microtrace/surface_interaction.hpp>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

namespace microtrace {

Surfaces::Surfaces(const Scene& scene, const Primitives& primitives, const SurfaceFinder& finder,
                   SharedTextures& textures)
    : scene_(scene),
      primitives_(primitives),
      finder_(finder),
      none_(static_cast<std::uint32_t>(scene.materials.size())),
      colors_(scene.textures.size()) {
  for (const Material& material : scene.materials)
    for (const bool has_colors : {false, true}) entries_.push_back(entry_of(material, has_colors));
  for (const bool has_colors : {false, true}) entries_.push_back(entry_of({}, has_colors));
  for (const ObjectRun& run : scene.objects.runs()) {
    const Material& material = material_of(scene, *run.first);
    if (material.base_color_texture) make_map(material.base_color_texture->texture, textures);
  }
}

Surfaces::Entry Surfaces::entry_of(const Material& material, bool has_colors) {
  const bool is_opaque = material.alpha_mode == AlphaMode::opaque;
  Entry entry{.color = Vec3(material.base_color),
              .kind = Kind::plain,
              .visibility = !is_opaque              ? Visibility::varies
                            : material.double_sided ? Visibility::always
                                                    : Visibility::in_front};
  if (!is_opaque || material.base_color_texture || has_colors) {
    entry.kind = Kind::various;
  } else if (!material.double_sided) {
    entry.kind = Kind::one_sided;
  }
  return entry;
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

void Surfaces::make_map(std::uint32_t index, SharedTextures& textures) {
  const Texture& texture = scene_.textures[index];
  std::optional<TextureMap>& map = colors_[index];
  if (map || !texture.image || !scene_.images[*texture.image]) return;
  map.emplace(textures.map(scene_.images[*texture.image], texture.sampler, ColorEncoding::srgb));
}

DVec4 Surfaces::texel(const World& world, const TextureUse& use, const Ray& ray,
                      const SurfaceInteraction& at) const {
  const std::optional<TextureMap>& map = colors_[use.texture];
  if (!map) return DVec4(1);
  const DVec2 uv = at.uv(use.uv_set).value_or(DVec2(0));
  const auto& m = use.texture_from_uv;
  const auto linear = [&m](const DVec2& v) { return DVec2(m[0]) * v.x + DVec2(m[1]) * v.y; };

  // Intersects the rays of the neighboring samples with the plane of the surface (H. Igehy, Tracing
  // ray differentials, 1999).
  const RayDifferential step = world.camera.differential(ray);
  const double sample_width = 1 / std::sqrt(static_cast<double>(world.samples));  // in pixels
  const DVec3 d(ray.d);
  const double t = glm::dot(at.p - DVec3(ray.o), d) / glm::dot(d, d);
  const double slant = glm::dot(d, at.n);
  const auto uv_step = [&](const DVec3& o_step, const DVec3& d_step) {
    const DVec3 moved = o_step + t * d_step;
    return linear(at.uv_step(use.uv_set, moved - d * (glm::dot(moved, at.n) / slant))) *
           sample_width;
  };
  return map->look_up(linear(uv) + DVec2(m[2]),
                      {.dx = uv_step(step.o_dx, step.d_dx), .dy = uv_step(step.o_dy, step.d_dy)});
}

BaseColor Surfaces::base_color(const World& world, const Ray& ray, const Hit& hit) const {
  const Material& material = material_of(scene_, *primitives_.object_of(hit.id).first);
  const SurfaceInteraction at = interact(primitives_, ray, hit);
  if (!at.front && !material.double_sided) return {.is_culled = true};
  DVec4 product = DVec4(material.base_color) * at.color();
  if (material.base_color_texture) product *= texel(world, *material.base_color_texture, ray, at);
  Vec4 color(product);
  const float alpha = color.w;
  switch (material.alpha_mode) {
    case AlphaMode::opaque:
      color.w = 1;
      break;
    case AlphaMode::mask:
      color.w = alpha >= material.alpha_cutoff ? 1 : 0;
      break;
    case AlphaMode::blend:
      color.w = std::clamp(alpha, 0.0F, 1.0F);
      break;
  }
  return {.color = color, .alpha = alpha};
}

bool Surfaces::is_same_point(const Ray& ray, const Hit& a, const Hit& b) const {
  const PlacedObject object = primitives_.object_of(a.id);
  if (a.t != b.t || !object.mesh || b.id < object.first_id || b.id >= object.end_id) return false;
  const Triangle one = triangle_of(object.mesh, a.id - object.first_id),
                 other = triangle_of(object.mesh, b.id - object.first_id);
  // Compares positions, because vertices with different indices coincide at texture seams.
  const auto is_corner = [&other](const Vec3& p) {
    return p == other.a || p == other.b || p == other.c;
  };
  return (is_corner(one.a) || is_corner(one.b) || is_corner(one.c)) &&
         shows_front(one, ray.d) == shows_front(other, ray.d) &&
         ExactHits(primitives_, ray).order(a.id, b.id) == 0;
}

bool Surfaces::is_visible(const World& world, const Ray& ray, const Hit& hit) const {
  switch (visibility(hit.id)) {
    case Visibility::always:
      return true;
    case Visibility::in_front:
      return is_front(ray, hit);
    case Visibility::varies:
      break;
  }
  return base_color(world, ray, hit).color.w > 0;
}

std::optional<Hit> Surfaces::first_visible(const World& world, const Ray& ray,
                                           std::optional<Hit> hit) const {
  while (hit && !is_visible(world, ray, *hit)) hit = world.bvh.next(ray, *hit);
  return hit;
}

Vec4 World::base_color(const Ray& ray, const Hit& hit) const {
  return surfaces.base_color(*this, ray, hit).color;
}

std::optional<Hit> World::first_visible(const Ray& ray, std::optional<Hit> hit) const {
  return surfaces.first_visible(*this, ray, hit);
}

}  // namespace microtrace
