#include "scene/mesh/weld.hpp"

#include <bit>
#include <cstddef>

namespace microtrace {
namespace {

constexpr std::uint32_t kFree = ~std::uint32_t{0};

/// Mixes a number into a hash; -0 counts as +0.
void mix(std::uint64_t& hash, float x) {
  hash = (hash ^ std::bit_cast<std::uint32_t>(x + 0.0F)) * 0x9E3779B97F4A7C15ULL;
  hash ^= hash >> 32U;
}

}  // namespace

std::vector<std::uint32_t> welded(std::span<const Vec3> positions, std::span<const Vec3> normals,
                                  std::span<const Vec2> uv) {
  const auto hash_of = [&](std::size_t i) {
    std::uint64_t hash = 0;
    for (const Vec3& v : {positions[i], normals[i]}) mix(hash, v.x), mix(hash, v.y), mix(hash, v.z);
    mix(hash, uv[i].x), mix(hash, uv[i].y);
    return static_cast<std::size_t>(hash);
  };
  const auto same = [&](std::size_t i, std::size_t k) {
    return positions[i] == positions[k] && normals[i] == normals[k] && uv[i] == uv[k];
  };
  // A hash table with linear probing that is at most half full. Each entry is the first vertex with
  // its combination of attributes.
  std::vector<std::uint32_t> table(std::bit_ceil(2 * positions.size() + 1), kFree);
  const std::size_t mask = table.size() - 1;
  std::vector<std::uint32_t> result(positions.size());
  for (std::uint32_t i = 0; i < result.size(); ++i) {
    std::size_t place = hash_of(i) & mask;
    while (table[place] != kFree && !same(table[place], i)) place = (place + 1) & mask;
    if (table[place] == kFree) table[place] = i;
    result[i] = table[place];
  }
  return result;
}

}  // namespace microtrace
