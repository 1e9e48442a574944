#include "io/gltf/material/textures.hpp"

#include "io/gltf/document/extension.hpp"
#include "io/gltf/document/properties.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace microtrace::io::gltf {
namespace {

Wrap wrap(const JsonValue& sampler, std::string_view key) {
  const JsonValue* mode = sampler.find(key);
  if (mode == nullptr || mode->number() == 10497) return Wrap::repeat;
  return mode->number() == 33071 ? Wrap::clamp_to_edge : Wrap::mirrored_repeat;
}

/// Converts a sampler's OpenGL constants. Odd filters are linear within an image. Those from 9984
/// on use mip maps, and those from 9986 on interpolate between mip levels.
Sampler make_sampler(const JsonValue& json) {
  Sampler sampler{.wrap_s = wrap(json, "wrapS"), .wrap_t = wrap(json, "wrapT")};
  const auto filter = [](int name) { return name % 2 == 0 ? Filter::nearest : Filter::linear; };
  sampler.magnification = filter(static_cast<int>(number(json, "magFilter", 9729)));
  const int minification = static_cast<int>(number(json, "minFilter", 9987));
  sampler.minification = filter(minification);
  if (minification < 9986) {
    sampler.mip = minification < 9984 ? MipFilter::none : MipFilter::nearest;
  }
  return sampler;
}

}  // namespace

std::vector<std::uint32_t> images_of(const JsonValue& texture) {
  const std::array<const JsonValue*, 3> sources = {
      extension(texture, "EXT_texture_webp"), extension(texture, "KHR_texture_basisu"), &texture};
  std::vector<std::uint32_t> images;
  for (const JsonValue* source : sources) {
    if (source != nullptr && source->find("source") != nullptr)
      images.push_back(index(*source, "source"));
  }
  return images;
}

std::vector<Texture> make_textures(Asset& asset) {
  std::vector<Texture> textures;
  for (const JsonValue& json : asset.array("textures")) {
    Texture texture{.name = name_of(json)};
    const std::vector<std::uint32_t> images = images_of(json);
    if (!images.empty()) {
      texture.image = images[0];
    } else {
      asset.warn(asset.element("textures", textures.size()),
                 "has no image in PNG, JPEG, WebP or KTX2; it is white");
    }
    if (const JsonValue* sampler = json.find("sampler")) {
      texture.sampler = make_sampler(asset.array("samplers")[index_from(*sampler)]);
    }
    textures.push_back(std::move(texture));
  }
  return textures;
}

}  // namespace microtrace::io::gltf
