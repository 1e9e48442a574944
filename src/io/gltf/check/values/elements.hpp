#pragma once
/// The numbers of an accessor where they lie, for checks that must be quick.

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
  /// Nothing for an accessor whose numbers are not all at hand: no data, compressed, or sparse and
  /// longer than is worth putting together. Throws Error (invalid_scene) where sparse indices are
  /// out of order or range.
  [[nodiscard]] static std::optional<Elements> of(const Asset& asset, const Model& model,
                                                  const BufferViews& views, std::size_t accessor);

  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t components() const { return components_; }
  [[nodiscard]] std::size_t stride() const { return stride_; }  ///< bytes from one to the next
  [[nodiscard]] int component_type() const { return component_type_; }

  /// Number may be an array of several.
  template <typename Number>
  [[nodiscard]] Number at(std::size_t element, std::size_t component) const {
    Number value;
    std::memcpy(&value, start() + element * stride_ + component * sizeof value, sizeof value);
    return value;
  }

  /// One component as a number, whatever its type.
  [[nodiscard]] double number(std::size_t element, std::size_t component) const;

 private:
  [[nodiscard]] const char* start() const {
    return storage_.empty() ? bytes_.data() : storage_.data();
  }

  std::string_view bytes_;
  std::string storage_;  // of sparse ones
  std::size_t stride_ = 0, count_ = 0, components_ = 0;
  int component_type_ = 0;
};

}  // namespace microtrace::io::gltf
