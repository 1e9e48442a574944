#pragma once
/// The declared formats of accessors, and the purposes for which they are used.

#include "io/gltf/document/asset.hpp"
#include "io/gltf/document/properties.hpp"

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// Format of one element.
struct Format {
  std::string_view type;   ///< empty if unknown
  int component_type = 0;  ///< OpenGL constant; 0 if unknown
  bool normalized = false;

  bool operator==(const Format&) const = default;
  /// Returns the format in words, for example "VEC3 of componentType 5126".
  [[nodiscard]] std::string text() const;
};

struct AccessorHead {
  Format format;
  double count = 0;
  bool has_bounds = false;  ///< true if both min and max are present
  std::optional<std::size_t> view{};
  std::size_t offset = 0;  ///< from the start of the view
  std::size_t stride = 0;  ///< stride of the view; 0 if absent
  std::size_t start = 0;   ///< from the start of the buffer
};

/// The purpose of a buffer view or accessor. Each must serve only one purpose (glTF 2.0, section
/// 3.6.2.1).
enum class Purpose {
  none,
  vertex_attribute,
  vertex_indices,
  inverse_bind_matrices,
  animation_input,
  animation_output,
  image,
};

class AccessorHeads {
 public:
  /// Expects an asset that check_schema has accepted.
  explicit AccessorHeads(Asset& asset);

  [[nodiscard]] const AccessorHead& operator[](std::size_t accessor) const {
    return heads_[accessor];
  }
  [[nodiscard]] const AccessorHead& operator[](const JsonValue& index) const {
    return heads_[index_from(index)];
  }

  /// Records that the index `at` refers to an accessor, and uses it and its view for this purpose.
  /// Warns if either already has a different purpose, if the view's target contradicts the purpose,
  /// if the view has a stride that the purpose forbids, or if two vertex attributes share a view
  /// without a stride.
  void use(const Element& at, Purpose purpose);
  void use_view(const Element& at, std::size_t view, Purpose purpose);

 private:
  Asset& asset_;
  std::vector<AccessorHead> heads_;
  std::vector<Purpose> purposes_;            // by accessor
  std::vector<Purpose> view_purposes_;       // by view
  std::vector<std::size_t> view_accessors_;  // by view: index of its first vertex attribute, plus 1
};

[[nodiscard]] bool is_one_of(const Format& format, std::initializer_list<Format> formats);

}  // namespace microtrace::io::gltf
