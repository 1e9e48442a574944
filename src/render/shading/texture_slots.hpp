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
  /// The scene must outlive this.
  explicit TextureMaps(const Scene& scene) : scene_(scene) {}

  /// All slots of a material. Material and this must outlive them.
  [[nodiscard]] TexturedMaterial slots(const Material& material);

 private:
  [[nodiscard]] TextureSlot slot(const std::optional<TextureUse>& use, ColorEncoding encoding);

  const Scene& scene_;
  std::map<std::pair<std::uint32_t, ColorEncoding>, TextureMap> maps_;
};

}  // namespace microtrace
