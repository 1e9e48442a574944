#pragma once
/// Accesses an accessor's elements directly, for fast checks.

#include "io/gltf/bytes/accessors.hpp"

#include <cstddef>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io::gltf {

class Elements {
 public:
  /// Returns nothing for an accessor without data, a compressed one, or a sparse one that is too
  /// large to assemble. Throws Error (invalid_scene) if sparse indices are out of order or range.
  [[nodiscard]] static std::optional<Elements> of(const Asset& asset, const Model& model,
                                                  const BufferViews& views, std::size_t accessor);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t components() const { return components_; }
  /// Returns the number of bytes between the starts of neighboring elements.
  [[nodiscard]] std::size_t stride() const { return stride_; }
  [[nodiscard]] int component_type() const { return component_type_; }

  /// Reads one component as Number, or several as a std::array.
  template <typename Number>
  [[nodiscard]] Number at(std::size_t element, std::size_t component) const {
    Number value;
    std::memcpy(&value, start() + element * stride_ + component * sizeof value, sizeof value);
    return value;
  }

  /// Returns one component of an element, converted from any component type.
  [[nodiscard]] double number(std::size_t element, std::size_t component) const;

 private:
  [[nodiscard]] const char* start() const {
    return storage_.empty() ? bytes_.data() : storage_.data();
  }

  std::string_view bytes_;
  std::string storage_;  // assembled elements of a sparse accessor
  std::size_t stride_ = 0, count_ = 0, components_ = 0;
  int component_type_ = 0;
};

}  // namespace microtrace::io::gltf
