#pragma once
/// Opacity micromaps: which parts of a triangle are certainly transparent or certainly not, so that
/// most hits need no texture lookup. See NVIDIA, Opacity Micro-Map, 2022 (VK_EXT_opacity_micromap).

#include "render/textures/alpha_bounds.hpp"

#include <microtrace/math.hpp>
#include <microtrace/shape.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <vector>

namespace microtrace {

struct TexturedMaterial;

/// Whether the coverage of a material without a filter is 0.
enum class Opacity : std::uint8_t { unknown, transparent, visible };

/// The maps of the triangles of meshes. Each map divides the barycentric coordinates into a grid of
/// cells.
class OpacityMaps {
 public:
  static constexpr double kTolerance = 0x1p-12;

  /// Adds the maps of all triangles of a mesh with a material, unless they are known. Returns the
  /// number of the first triangle's map.
  std::size_t add(const PlacedMesh& placed, const TexturedMaterial& look);
  /// Releases what only add() needs.
  void finish();

  /// The opacity at any SurfacePoint whose weights of the second and the third vertex differ from
  /// these numbers by at most kTolerance. `map` is the number of the triangle's map.
  [[nodiscard]] Opacity at(std::size_t map, float second, float third) const {
    const Map& found = maps_[map];
    const std::uint32_t size = 1U << found.log_size;
    const auto cell = [size](float x) {
      const auto whole = static_cast<std::int32_t>(x * static_cast<float>(size));
      return std::min(static_cast<std::uint32_t>(std::max(whole, 0)), size - 1);
    };
    const std::uint32_t index = cell(third) * size + cell(second);
    return static_cast<Opacity>(cells_[found.begin + index / kPerWord] >> index % kPerWord * kBits &
                                kMask);
  }
  /// The opacity if it is the same at all points of the triangle, otherwise unknown.
  [[nodiscard]] Opacity everywhere(std::size_t map) const {
    return maps_[map].log_size == 0 ? at(map, 0, 0) : Opacity::unknown;
  }

 private:
  static constexpr std::uint32_t kBits = 2, kMask = 3, kPerWord = 32 / kBits;
  /// A map of size x size cells, which begin at cells_[begin]. Those with one cell are shared: the
  /// word with the number of an opacity has this opacity.
  struct Map {
    std::uint32_t begin : 28, log_size : 4;
  };
  /// Cells of a map.
  struct Square {
    std::uint32_t x, y, size;
  };
  struct TriangleAlpha;
  /// What the maps of a mesh, or the map of a triangle, depend on.
  using MeshKey = std::array<const void*, 6>;
  using TriangleKey = std::array<std::uint32_t, 11>;
  struct HashOfKey {
    [[nodiscard]] std::size_t operator()(const TriangleKey& key) const;
  };

  [[nodiscard]] static Map uniform(Opacity opacity) {
    return {.begin = static_cast<std::uint32_t>(opacity), .log_size = 0};
  }
  [[nodiscard]] Map map_of(const TriangleAlpha& triangle);
  /// Sets the cells of a square, which is one of a grid of such squares.
  void fill(const Map& map, const TriangleAlpha& triangle, const Square& square);

  std::vector<Map> maps_;
  std::vector<std::uint32_t> cells_{0, 1, 2};
  // Data of add().
  std::map<MeshKey, std::size_t> meshes_;  // the numbers of the first maps
  std::unordered_map<TriangleKey, Map, HashOfKey> triangles_;
  std::map<const Image*, AlphaBounds> bounds_;
};

}  // namespace microtrace
