#pragma once
/// The list of extensions, with the data that the reader and the schema need for each.
///
/// To add KHR_materials_example, add its properties to <microtrace/material.hpp>, their textures to
/// scene/material_textures.hpp, its rules, reader and row to material_extensions.cpp, its effect to
/// render/shading, and its name to docs/gltf.md. The compiler or extension_test names anything that
/// you forget. Other extensions have their rows in other_extensions.cpp.

#include "io/gltf/document/rules.hpp"
#include "io/json/document.hpp"

#include <microtrace/material.hpp>

#include <array>
#include <span>
#include <string_view>

namespace microtrace::io::gltf {

/// How an asset that uses an extension is handled.
enum class Support {
  full,      ///< rendered as the extension specifies
  harmless,  ///< ignored with a warning; the picture is correct without it
  none,      ///< ignored with a warning; rejected if the asset requires it
};

/// The object that an extension adds to objects of one kind.
struct ExtensionObject {
  Place place = Place::nowhere;
  std::span<const Rule> rules{};
};

struct Extension {
  std::string_view name{};
  Support support = Support::none;
  std::array<ExtensionObject, 8> objects{};
  /// Reads the extension's object in a material. Null if the extension adds none to materials.
  void (*read_material)(const JsonValue& object, Material& material) = nullptr;
  /// The media type of images to which textures can refer only through this extension. Empty if the
  /// extension adds no image type.
  std::string_view image_type{};

  /// The object that the extension adds to objects of this kind, or null.
  [[nodiscard]] const ExtensionObject* object_in(Place place) const;
};

/// Returns all known extensions, sorted by name. Unknown extensions are ignored with a warning.
[[nodiscard]] std::span<const Extension> extensions();

/// The extension with this name, or null.
[[nodiscard]] const Extension* find_extension(std::string_view name);

/// The two parts of the list that extensions() returns.
[[nodiscard]] std::span<const Extension> material_extensions();
[[nodiscard]] std::span<const Extension> other_extensions();

}  // namespace microtrace::io::gltf
