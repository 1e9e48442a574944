#pragma once
/// Reads arrays of numbers in NumPy's format .npy, versions 1 to 3.

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace microtrace::io {

struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;  ///< in row-major order
};

/// Reads an array of little-endian integers or floating-point numbers of 32 or 64 bits, in
/// row-major or column-major order. `file` and `name` are for messages. Throws Error
/// (invalid_scene).
[[nodiscard]] NpyArray read_npy(std::string_view bytes, const std::string& file,
                                const std::string& name);

/// Returns a shape as Python writes it, such as "(3, 4)" or "(5,)".
[[nodiscard]] std::string shape_text(const std::vector<std::size_t>& shape);

}  // namespace microtrace::io
