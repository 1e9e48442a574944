#include "io/gltf/bytes/meshopt_filters.hpp"

#include "gltf/asset_builder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <gmock/gmock.h>

namespace microtrace::tests {
namespace {

using ::testing::ElementsAre;

template <typename Number>
std::vector<Number> filtered(const std::vector<Number>& numbers,
                             const std::function<void(std::string&)>& filter) {
  std::string bytes = bytes_of(numbers);
  filter(bytes);
  std::vector<Number> result(numbers.size());
  std::memcpy(result.data(), bytes.data(), bytes.size());
  return result;
}

TEST(GltfMeshoptFilters, OctahedralFilterGivesUnitVectors) {
  const auto decode8 = [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 4); };
  EXPECT_THAT(filtered<std::int8_t>({0, 0, 127, 5, 127, 0, 127, 6, 0, -127, 127, -7}, decode8),
              ElementsAre(0, 0, 127, 5, 127, 0, 0, 6, 0, -127, 0, -7));
  // The lower pole maps to every corner of the square.
  EXPECT_THAT(filtered<std::int8_t>({7, 7, 7, 0, -7, 7, 7, 0}, decode8),
              ElementsAre(0, 0, -127, 0, 0, 0, -127, 0));
  const auto decode16 = [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 8); };
  EXPECT_THAT(filtered<std::int16_t>({0, 0, 511, 3, 0, 511, 511, -4}, decode16),
              ElementsAre(0, 0, 32767, 3, 0, 32767, 0, -4));
  // Meaningless input must not cause undefined behavior.
  (void)filtered<std::int16_t>({1, -1, 0, 3, -32768, 32767, -1, 0, 0, 0, 0, 0}, decode16);
}

TEST(GltfMeshoptFilters, QuaternionFilterRestoresTheLargestComponent) {
  // The last number of each quaternion is 2047, the maximum of 12 bits, except for its two low
  // bits. These are the index of the largest component: 3 and 1.
  const std::vector<std::int16_t> stored = {0, 0, 0, 2047, 2047, 0, 0, 2045, 0, 0, 0, 0};
  const auto decoded = filtered<std::int16_t>(stored, io::gltf::decode_quaternions);
  EXPECT_THAT(std::vector(decoded.begin(), decoded.begin() + 4), ElementsAre(0, 0, 0, 32767));
  EXPECT_THAT(std::vector(decoded.begin() + 4, decoded.begin() + 8),
              ElementsAre(0, 23170, 23170, 0));
}

/// Evaluates the octahedral filter's definition in float64.
std::array<double, 3> octahedral_vector(double x, double y, double one) {
  x /= one, y /= one;
  const double z = 1 - std::abs(x) - std::abs(y), t = std::min(z, 0.0);
  x -= std::copysign(t, x);
  y -= std::copysign(t, y);
  const double length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

TEST(GltfMeshoptFilters, OctahedralFilterEqualsItsDefinition) {
  std::mt19937 random(3);
  std::vector<std::int16_t> stored;
  for (int i = 0; i < 2000; ++i) {
    const int x = static_cast<int>(random() % 1023) - 511;
    const int y = static_cast<int>(random() % 1023) - 511;
    for (const int v : {x, y, 511, i}) stored.push_back(static_cast<std::int16_t>(v));
  }
  const std::vector<std::int16_t> decoded = filtered<std::int16_t>(
      stored, [](std::string& bytes) { io::gltf::decode_octahedral(bytes, 8); });
  for (std::size_t i = 0; i < stored.size(); i += 4) {
    const std::array<double, 3> expected = octahedral_vector(stored[i], stored[i + 1], 511);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(decoded[i + k], expected[k] * 32767, 0.51) << i;
    EXPECT_EQ(decoded[i + 3], stored[i + 3]);
  }
}

/// Checks all colors of `bits` bits: converts them to YCoCg and back.
template <typename Integer>
void check_colors(int bits) {
  const int one = (1 << bits) - 1, step = std::max(1, one / 24);
  std::vector<Integer> stored, expected;
  for (int r = 0; r <= one; r += step) {
    for (int g = 0; g <= one; g += step) {
      for (int b = 0; b <= one; b += step) {
        // The reversible conversion loses the last bit of each chroma, like an encoder.
        const int orange = (r - b) / 2, green = (g - (b + orange)) / 2, luma = b + orange + green;
        const int alpha = (r + b) % ((one >> 1) + 1);
        for (const int v : {luma, orange, green, alpha | 1 << (bits - 1)}) {
          stored.push_back(static_cast<Integer>(v));
        }
        for (const int v :
             {luma + orange - green, luma + green, luma - orange - green, 2 * alpha + alpha % 2}) {
          const double scaled = std::clamp(v, 0, one) * 1.0 / one;
          expected.push_back(static_cast<Integer>(
              std::round(scaled * static_cast<double>(std::numeric_limits<Integer>::max()))));
        }
      }
    }
  }
  EXPECT_EQ(
      filtered<Integer>(
          stored, [](std::string& bytes) { io::gltf::decode_colors(bytes, 4 * sizeof(Integer)); }),
      expected)
      << bits;
}

TEST(GltfMeshoptFilters, ColorFilterGivesTheNearestColors) {
  for (int bits = 2; bits <= 8; ++bits) check_colors<std::uint8_t>(bits);
  for (int bits = 2; bits <= 16; ++bits) check_colors<std::uint16_t>(bits);
}

TEST(GltfMeshoptFilters, ColorFilterClampsMeaninglessColors) {
  const auto decode8 = [](std::string& bytes) { io::gltf::decode_colors(bytes, 4); };
  // An alpha of 0 marks no number of bits.
  EXPECT_THAT(filtered<std::uint8_t>({255, 127, 128, 255, 0, 128, 127, 128, 9, 9, 9, 0}, decode8),
              ElementsAre(255, 127, 255, 255, 0, 127, 1, 0, 0, 0, 0, 0));
}

}  // namespace
}  // namespace microtrace::tests
