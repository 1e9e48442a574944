#pragma once
/// The textures of materials, ready for lookup.

#include "render/shading/shading.hpp"
#include "render/textures/shared_textures.hpp"
#include "render/textures/texture_map.hpp"

#include <microtrace/scene.hpp>

#include <cstdint>
#include <map>
#include <utility>

namespace microtrace {

/// Texture maps for each combination of texture and encoding. Each map is created once.
class TextureMaps {
 public:
  /// Both must outlive this object.
  TextureMaps(const Scene& scene, SharedTextures& textures) : scene_(scene), textures_(textures) {}

  /// Returns a material with its texture slots. The material and this object must outlive the
  /// result.
  [[nodiscard]] TexturedMaterial slots(const Material& material);

 private:
  [[nodiscard]] TextureSlot slot(const TextureUse& use, ColorEncoding encoding);

  const Scene& scene_;
  SharedTextures& textures_;
  std::map<std::pair<std::uint32_t, ColorEncoding>, TextureMap> maps_;
};

/// Sets look.kernel_surfaces if it is not set and look.constant_but_textures is.
void set_kernel_surfaces(TexturedMaterial& look);

}  // namespace microtrace
