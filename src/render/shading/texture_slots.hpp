#pragma once
/// The textures of materials, ready to be looked up.

#include "render/shading/shading.hpp"
#include "render/texture_map.hpp"

#include <microtrace/scene.hpp>

#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace microtrace {

/// By texture and encoding, each made once.
class TextureMaps {
 public:
  /// Both must outlive this.
  TextureMaps(const Scene& scene, TexturePyramids& pyramids) : scene_(scene), pyramids_(pyramids) {}

  /// All slots of a material. Material and this must outlive them.
  [[nodiscard]] TexturedMaterial slots(const Material& material);

 private:
  [[nodiscard]] TextureSlot slot(const std::optional<TextureUse>& use, ColorEncoding encoding);

  const Scene& scene_;
  TexturePyramids& pyramids_;
  std::map<std::pair<std::uint32_t, ColorEncoding>, TextureMap> maps_;
};

}  // namespace microtrace
