#pragma once
/// Arrays in the .npz format of NumPy: a ZIP archive of .npy files.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace microtrace::dataset {

/// A named array in row-major order. The values must outlive it.
struct NpzArray {
  std::string name;  ///< without .npy
  std::vector<std::size_t> shape;
  std::variant<std::span<const float>, std::span<const std::uint32_t>,
               std::span<const std::uint8_t>>
      values;
};

/// Returns a .npz file, uncompressed, whose bytes depend only on the arguments. Throws Error: usage
/// if names are empty or repeated or a shape doesn't match the number of values, limit if the file
/// would be larger than 4 GiB or has more than 65 535 arrays.
[[nodiscard]] std::string npz(std::span<const NpzArray> arrays);

}  // namespace microtrace::dataset
