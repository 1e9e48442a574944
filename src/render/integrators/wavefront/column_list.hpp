#pragma once
#include "render/lanes/shading_kernels.hpp"

#include <array>
#include <cstdint>

namespace microtrace {

/// Arrays of 32-bit values whose lanes ShadingKernels::append copies.
class ColumnList {
 public:
  /// Empties the list unless it was begun for the same object, whose arrays it lists. Returns true
  /// if the list is empty and must be filled.
  [[nodiscard]] bool begins(const void* object) {
    if (object_ == object) return false;
    object_ = object;
    count_ = 0;
    return true;
  }
  void add(const float* from, float* to) {
    columns_[static_cast<std::size_t>(count_++)] = {.from = from, .to = to};
  }
  void add(const std::uint32_t* from, std::uint32_t* to) {
    // Kernels copy the bits without interpreting them.
    add(reinterpret_cast<const float*>(from), reinterpret_cast<float*>(to));
  }
  /// Adds all components of a vector.
  template <std::size_t n, class T, std::size_t from_size, std::size_t to_size>
  void add(const T (&from)[n][from_size], T (&to)[n][to_size]) {
    for (std::size_t i = 0; i < n; ++i) add(from[i], to[i]);
  }

  /// Returns the number of lanes.
  std::size_t append(const ShadingKernels& kernels, const AppendedLanes& lanes) const {
    return static_cast<std::size_t>(kernels.append(columns_.data(), count_, lanes));
  }

 private:
  const void* object_ = nullptr;
  std::array<ColumnCopy, 64> columns_;
  int count_ = 0;
};

}  // namespace microtrace
