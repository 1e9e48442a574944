#pragma once
#include "io/json/document.hpp"

#include <string>
#include <string_view>

namespace microtrace::io::gltf {

/// The JSON of an asset. Some tools copy names from older files in Latin-1, which glTF 2.0 forbids.
/// If the text is not UTF-8, the bytes that aren't are read as Latin-1.
class AssetJson {
 public:
  /// Throws Error (invalid_scene, limit), as JsonDocument does. `text` must outlive this object.
  AssetJson(std::string_view text, const std::string& name);

  [[nodiscard]] JsonDocument& document() { return document_; }
  [[nodiscard]] bool has_latin1() const { return !converted_.empty(); }

 private:
  [[nodiscard]] JsonDocument parsed(std::string_view text, const std::string& name);

  std::string converted_;  // the whole text in UTF-8, if it was not
  JsonDocument document_;
};

}  // namespace microtrace::io::gltf
