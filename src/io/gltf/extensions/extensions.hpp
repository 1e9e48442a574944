#pragma once
/// The list of extensions: all that the reader, the schema and the documentation know of them.
///
/// To add KHR_materials_example: its properties in <microtrace/material.hpp>, their textures in
/// scene/material_textures.hpp, its rules, its reader and its row in material_extensions.cpp, what
/// it does in render/shading, and its name in docs/gltf.md. The compiler or extension_test names
/// what is forgotten. Other extensions have their rows in other_extensions.cpp.

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
  harmless,  ///< ignored with a warning; the picture is right without it
  none,      ///< ignored with a warning, but refused if the asset requires it
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
  /// Reads the extension's object of a material; null if it adds none to materials.
  void (*read_material)(const JsonValue& object, Material& material) = nullptr;
  /// Media type of the images that textures can refer to through this extension; otherwise empty.
  std::string_view image_type{};

  /// The object that the extension adds to objects of that kind, or null.
  [[nodiscard]] const ExtensionObject* object_in(Place place) const;
};

/// All known extensions, by name. Unknown ones are ignored with a warning.
[[nodiscard]] std::span<const Extension> extensions();

/// The extension with that name, or null.
[[nodiscard]] const Extension* find_extension(std::string_view name);

/// The parts of the list.
[[nodiscard]] std::span<const Extension> material_extensions();
[[nodiscard]] std::span<const Extension> other_extensions();

}  // namespace microtrace::io::gltf
