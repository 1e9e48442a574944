#include "io/gltf/bytes/resource.hpp"
#include "io/gltf/bytes/uri.hpp"
#include "io/gltf/check/semantics.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/gltf/extensions/extensions.hpp"

#include <algorithm>
#include <string>

namespace microtrace::io::gltf {
namespace {

void check_uri(Asset& asset, const Element& at) {
  const std::string& uri = at.value->string();
  if (!is_data_uri(uri) && uri.find('\\') != std::string::npos)
    asset.tolerate(at, "has a backslash, which is read as /");
  if (is_data_uri(uri) && !split_data_uri(uri))
    asset.fail(at, "is not a data URI of the form data:TYPE;base64,DATA");
  tolerate_stray_percent(asset, at);
}

void check_media_type(Asset& asset, const Element& image) {
  const JsonValue* given = image.value->find("mimeType");
  if (given == nullptr) return;
  const auto known = std::ranges::find(extensions(), given->string(), &Extension::image_type);
  if (known == extensions().end() || known->image_type.empty() || asset.uses(known->name)) return;
  asset.tolerate(image.member("mimeType"),
                 "needs extension " + std::string(known->name) + ", which is not declared");
}

void check_image(Asset& asset, const Element& at, AccessorHeads& accessors) {
  check_media_type(asset, at);
  const bool has_view = at.value->find("bufferView") != nullptr;
  if (has_view == (at.value->find("uri") != nullptr)) {
    asset.fail(at, "must have either a uri or a bufferView");
  }
  if (!has_view) return check_uri(asset, at.member("uri"));
  if (at.value->find("mimeType") == nullptr) {
    asset.tolerate(at, "has a bufferView but no mimeType; the format is detected from the data");
  }
  const Element view = at.member("bufferView");
  accessors.use_view(view, index_from(*view.value), Purpose::image);
}

/// Warns if the property that refers to an image does not allow the image's declared type.
void check_source(Asset& asset, const Element& texture, std::string_view type,
                  std::string_view other_type) {
  const JsonValue* index = texture.value->find("source");
  if (index == nullptr) return;
  const JsonValue& image = asset.array("images")[index_from(*index)];
  const JsonValue* given = image.find("mimeType");
  if (given == nullptr || given->string() == type || given->string() == other_type) return;
  asset.tolerate(texture.member("source"), "refers to an image of " + given->string() +
                                               ", must be " + std::string(type) + " here");
}

}  // namespace

void check_images(Asset& asset, AccessorHeads& accessors) {
  for (std::size_t i = 0; i < asset.array("images").size(); ++i) {
    check_image(asset, asset.element("images", i), accessors);
  }
  for (std::size_t i = 0; i < asset.array("textures").size(); ++i) {
    const Element at = asset.element("textures", i);
    check_source(asset, at, "image/png", "image/jpeg");
    if (at.value->find("extensions") == nullptr) continue;
    for (const Extension& known : extensions()) {
      if (known.image_type.empty()) continue;
      const Element own = at.member("extensions").member(known.name);
      if (own.value->find("source") != nullptr) check_source(asset, own, known.image_type, "");
    }
  }
}

}  // namespace microtrace::io::gltf
