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

/// What becomes of an asset that uses an extension.
enum class Support {
  full,      ///< it is drawn as the extension says
  harmless,  ///< the extension is ignored, with a warning: the picture is the same without
  none,      ///< the same, but an asset that requires it is refused
};

/// The object that an extension adds to those of one kind.
struct ExtensionObject {
  Place place = Place::nowhere;
  std::span<const Rule> rules{};
};

struct Extension {
  std::string_view name{};
  Support support = Support::none;
  std::array<ExtensionObject, 8> objects{};
  /// Reads the object that a material has; null for extensions that add none to materials.
  void (*read_material)(const JsonValue& object, Material& material) = nullptr;
  /// The media type of the images that textures name by it; empty for other extensions.
  std::string_view image_type{};

  /// What it adds to an object of that kind, or null.
  [[nodiscard]] const ExtensionObject* object_in(Place place) const;
};

/// All, by name. Others are ignored with a warning, and not looked into.
[[nodiscard]] std::span<const Extension> extensions();

/// The extension of that name, or null.
[[nodiscard]] const Extension* find_extension(std::string_view name);

/// The parts of the list.
[[nodiscard]] std::span<const Extension> material_extensions();
[[nodiscard]] std::span<const Extension> other_extensions();

}  // namespace microtrace::io::gltf
