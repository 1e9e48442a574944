#pragma once
/// What accessors say of themselves, and what they are used for.

#include "io/gltf/document/asset.hpp"

#include <cstddef>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

/// How one element is stored.
struct Format {
  std::string_view type;   ///< empty where the asset's is unknown
  int component_type = 0;  ///< OpenGL's number; 0 where the asset's is unknown
  bool normalized = false;

  bool operator==(const Format&) const = default;
  /// As "VEC3 of 5126", for messages.
  [[nodiscard]] std::string text() const;
};

struct AccessorHead {
  Format format;
  double count = 0;
  bool has_bounds = false;  ///< both min and max
  std::optional<std::size_t> view{};
  std::size_t offset = 0;  ///< within the view
  std::size_t stride = 0;  ///< the view's, 0 where it has none
  std::size_t start = 0;   ///< within the buffer
};

/// What a buffer view or an accessor is for. One serves one purpose (glTF 2.0, section 3.6.2.1).
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
  /// Of an asset that check_schema has accepted.
  explicit AccessorHeads(Asset& asset);

  [[nodiscard]] const AccessorHead& operator[](std::size_t accessor) const {
    return heads_[accessor];
  }
  [[nodiscard]] const AccessorHead& operator[](const JsonValue& index) const {
    return heads_[static_cast<std::size_t>(index.number)];
  }

  /// Notes the purpose for which `at`, an index, names an accessor, and what follows for its view.
  /// Warns where either has another purpose already, where the view's target is another, where a
  /// stride stands that the purpose does not allow, or two vertex attributes share a view without.
  void use(const Element& at, Purpose purpose);
  void use_view(const Element& at, std::size_t view, Purpose purpose);

 private:
  Asset& asset_;
  std::vector<AccessorHead> heads_;
  std::vector<Purpose> purposes_;            // by accessor
  std::vector<Purpose> view_purposes_;       // by view
  std::vector<std::size_t> view_accessors_;  // by view: one more than its first vertex attribute
};

[[nodiscard]] bool is_one_of(const Format& format, std::initializer_list<Format> formats);

}  // namespace microtrace::io::gltf
