#include "scene/mesh/merge.hpp"

#include "scene/material_textures.hpp"

#include <cstdint>
#include <iterator>
#include <utility>

namespace microtrace {
namespace {

template <typename Item>
std::uint32_t append(std::vector<Item>& whole, std::vector<Item>& part) {
  const auto first = static_cast<std::uint32_t>(whole.size());
  whole.insert(whole.end(), std::move_iterator(part.begin()), std::move_iterator(part.end()));
  return first;
}

}  // namespace

void merge(Scene& whole, Scene&& part) {
  const std::uint32_t first_image = append(whole.images, part.images);
  for (Texture& texture : part.textures) {
    if (texture.image) *texture.image += first_image;
  }
  const std::uint32_t first_texture = append(whole.textures, part.textures);
  for (Material& material : part.materials) {
    for_each_texture(material,
                     [&](TextureUse& use, ColorEncoding) { use.texture += first_texture; });
  }
  const std::uint32_t first_material = append(whole.materials, part.materials);
  part.objects.edit_runs([&](Object& object) {
    if (object.material) *object.material += first_material;
  });
  whole.objects.append(std::move(part.objects));
}

}  // namespace microtrace
