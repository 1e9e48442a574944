#include "render/shading/opacity_maps.hpp"

#include "base/memory_account.hpp"
#include "render/shading/textured_material.hpp"

#include <bit>
#include <cmath>

namespace microtrace {
namespace {

/// Maps are computed for the first triangles, so that this number of cells is not exceeded. It
/// limits the time.
constexpr std::size_t kMostCells = std::size_t{1} << 21U;
constexpr std::uint32_t kLeastLogSize = 2, kMostLogSize = 7;
/// Triangles that are smaller, in texels, have no maps of their own.
constexpr double kLeastExtent = 4;
/// Larger than the relative errors of sums and products of a few float32 numbers.
constexpr double kSumRounding = 0x1p-20;
/// Exceeds the effect of underflow.
constexpr double kAlphaUnderflow = 0x1p-120;

ValueInterval bounds_of(const std::array<double, 4>& values, std::size_t count, double margin) {
  const auto [lo, hi] = std::minmax_element(values.begin(), values.begin() + count);
  return {.lo = *lo - margin, .hi = *hi + margin};
}

/// The opacity where the base color's alpha is in this interval.
Opacity opacity_within(const Material& material, const ValueInterval& alpha) {
  if (material.alpha_mode == AlphaMode::opaque) return Opacity::visible;
  const double lo = std::max(alpha.lo - kAlphaUnderflow, 0.0);
  if (material.alpha_mode == AlphaMode::mask) {
    if (lo >= material.alpha_cutoff) return Opacity::visible;
    return alpha.hi + kAlphaUnderflow < material.alpha_cutoff ? Opacity::transparent
                                                              : Opacity::unknown;
  }
  if (lo > 0) return Opacity::visible;
  return alpha.hi == 0 ? Opacity::transparent : Opacity::unknown;
}

}  // namespace

/// The alpha on a triangle.
struct OpacityMaps::TriangleAlpha {
  const TexturedMaterial* look;
  const AlphaBounds* texture;         ///< null if there is none
  std::array<Vec2, 3> mesh_uv{};      ///< of the vertices
  std::array<float, 3> vertex_alpha;  ///< of the vertices
  std::array<DVec2, 3> uv{};          ///< transformed for the texture
  DVec2 uv_error{0};  ///< of uv that SurfacePoint and TextureSlot compute, for these weights
  ValueInterval factor{1, 1};  ///< of the product of factors and vertex colors
  bool is_valid = true;        ///< false if the numbers are too large or negative

  TriangleAlpha(const PlacedMesh& placed, std::size_t triangle, const TexturedMaterial& of,
                const AlphaBounds* bounds);

  /// The opacity where the weights of the second and the third vertex are in the cell at (x, y) of
  /// a grid of size x size cells.
  [[nodiscard]] Opacity in_cell(std::uint32_t x, std::uint32_t y, std::uint32_t size) const;
  /// The greatest extent of the triangle in texels.
  [[nodiscard]] double extent() const;
  [[nodiscard]] TriangleKey key() const;

 private:
  void set_factor();
};

OpacityMaps::TriangleAlpha::TriangleAlpha(const PlacedMesh& placed, std::size_t triangle,
                                          const TexturedMaterial& of, const AlphaBounds* bounds)
    : look(&of), texture(bounds) {
  const Mesh& mesh = *placed.arrays;
  const std::array<std::uint32_t, 3> corners = placed.corners(triangle);
  for (std::size_t i = 0; i < 3; ++i)
    vertex_alpha[i] = mesh.colors.empty() ? 1 : mesh.colors[corners[i]].w;
  set_factor();
  if (texture == nullptr) return;
  // SurfacePoint::uv interpolates by float32 weights, whose sum is 1 but for rounding.
  const TextureUse& use = *of[MaterialTexture::base_color].use;
  const bool has_set = use.uv_set < mesh.uv_sets.size() && !mesh.uv_sets[use.uv_set].empty();
  const auto& m = use.texture_from_uv;
  uv_error = glm::abs(DVec2(m[2]));
  for (std::size_t i = 0; i < 3; ++i) {
    if (has_set) mesh_uv[i] = mesh.uv_sets[use.uv_set][corners[i]];
    const DVec2 at(mesh_uv[i]);
    uv[i] = DVec2(m[0]) * at.x + DVec2(m[1]) * at.y + DVec2(m[2]);
    uv_error += glm::abs(DVec2(m[0]) * at.x) + glm::abs(DVec2(m[1]) * at.y);
  }
  // Each point is at most as far from the origin as the sum of these terms.
  is_valid &= uv_error.x < 0x1p19 && uv_error.y < 0x1p19;
  uv_error *= kSumRounding;
  uv_error += kTolerance * (glm::abs(uv[1] - uv[0]) + glm::abs(uv[2] - uv[0]));
}

void OpacityMaps::TriangleAlpha::set_factor() {
  const auto [least, greatest] = std::ranges::minmax(vertex_alpha);
  const double constant = look->material->base_color.w;
  factor = {.lo = least * constant * (1 - kSumRounding),
            .hi = greatest * constant * (1 + kSumRounding)};
  is_valid = factor.lo >= 0 && factor.hi < 0x1p60;
}

Opacity OpacityMaps::TriangleAlpha::in_cell(std::uint32_t x, std::uint32_t y,
                                            std::uint32_t size) const {
  if (!is_valid) return Opacity::unknown;
  ValueInterval alpha = factor;
  if (texture != nullptr) {
    std::array<double, 4> u, v;
    // The cells on the third edge are halves.
    const std::size_t count = x + y + 1 < size ? 4 : 3;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double b = (x + (i & 1U)) / double{1} / size, c = (y + (i >> 1U)) / double{1} / size;
      const DVec2 at = uv[0] * (1 - b - c) + uv[1] * b + uv[2] * c;
      u[i] = at.x;
      v[i] = at.y;
    }
    const ValueInterval texel =
        texture->over(*(*look)[MaterialTexture::base_color].map, bounds_of(u, count, uv_error.x),
                      bounds_of(v, count, uv_error.y));
    alpha = {.lo = alpha.lo * texel.lo * (1 - kSumRounding),
             .hi = alpha.hi * texel.hi * (1 + kSumRounding)};
  }
  return opacity_within(*look->material, alpha);
}

double OpacityMaps::TriangleAlpha::extent() const {
  if (texture == nullptr || !is_valid) return 0;
  const Image& image = (*look)[MaterialTexture::base_color].map->image();
  const auto along = [&](auto axis, std::uint32_t texels) {
    const auto [lo, hi] = std::minmax({uv[0][axis], uv[1][axis], uv[2][axis]});
    return (hi - lo) * texels;
  };
  return std::max(along(0, image.width), along(1, image.height));
}

OpacityMaps::TriangleKey OpacityMaps::TriangleAlpha::key() const {
  TriangleKey key{};
  std::size_t i = 0;
  const auto add = [&](float x) { key[i++] = std::bit_cast<std::uint32_t>(x); };
  for (const Vec2& at : mesh_uv) add(at.x), add(at.y);
  for (const float alpha : vertex_alpha) add(alpha);
  const auto material = reinterpret_cast<std::uintptr_t>(look->material);
  key[i++] = static_cast<std::uint32_t>(material);
  key[i++] = static_cast<std::uint32_t>(std::uint64_t{material} >> 32U);
  return key;
}

std::size_t OpacityMaps::HashOfKey::operator()(const TriangleKey& key) const {
  std::uint64_t hash = 0;
  for (const std::uint32_t word : key) {
    hash = (hash ^ word) * 0x9e3779b97f4a7c15U;
    hash ^= hash >> 32U;
  }
  return hash;
}

std::size_t OpacityMaps::add(const PlacedMesh& placed, const TexturedMaterial& look) {
  const Mesh& mesh = *placed.arrays;
  const TextureSlot& slot = look[MaterialTexture::base_color];
  const void* uv = slot.map != nullptr && slot.use->uv_set < mesh.uv_sets.size()
                       ? mesh.uv_sets[slot.use->uv_set].data()
                       : nullptr;
  const MeshKey key{
      mesh.triangles.data(), mesh.triangles.data() + mesh.triangles.size(), uv, mesh.colors.data(),
      look.material,         placed.is_mirrored() ? this : nullptr};
  const auto [known, is_new] = meshes_.try_emplace(key, maps_.size());
  if (!is_new) return known->second;
  take_memory(mesh.triangles.size() * sizeof(Map), "the opacity of triangles");
  maps_.reserve(maps_.size() + mesh.triangles.size());
  const AlphaBounds* const bounds =
      slot.map == nullptr
          ? nullptr
          : &bounds_.try_emplace(&slot.map->image(), slot.map->image()).first->second;
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
    maps_.push_back(map_of(TriangleAlpha(placed, i, look, bounds)));
  return known->second;
}

OpacityMaps::Map OpacityMaps::map_of(const TriangleAlpha& triangle) {
  const Opacity everywhere = triangle.in_cell(0, 0, 1);
  const double extent = triangle.extent();
  if (everywhere != Opacity::unknown || !(extent >= kLeastExtent)) return uniform(everywhere);
  const TriangleKey key = triangle.key();
  if (const auto known = triangles_.find(key); known != triangles_.end()) return known->second;
  // About half a texel per cell.
  std::uint32_t log_size = kLeastLogSize;
  while (log_size < kMostLogSize && 1U << log_size < 2 * extent) ++log_size;
  const std::size_t words = (std::size_t{1} << 2 * log_size) / kPerWord;
  if ((cells_.size() + words) * kPerWord > kMostCells) return uniform(Opacity::unknown);
  take_memory(words * sizeof cells_[0], "the opacity of triangles");
  const auto begin = static_cast<std::uint32_t>(cells_.size());
  cells_.resize(cells_.size() + words);
  const Map map{.begin = begin & 0xfffffffU, .log_size = log_size & 0xfU};
  fill(map, triangle, {.x = 0, .y = 0, .size = 1U << log_size});
  triangles_.emplace(key, map);
  return map;
}

void OpacityMaps::fill(const Map& map, const TriangleAlpha& triangle, const Square& square) {
  const std::uint32_t size = 1U << map.log_size;
  if (square.x + square.y >= size) return;  // outside of the triangle
  const Opacity opacity =
      triangle.in_cell(square.x / square.size, square.y / square.size, size / square.size);
  if (opacity == Opacity::unknown && square.size > 1) {
    const std::uint32_t half = square.size / 2;
    for (std::uint32_t i = 0; i < 4; ++i)
      fill(map, triangle,
           {.x = square.x + (i & 1U) * half, .y = square.y + (i >> 1U) * half, .size = half});
    return;
  }
  for (std::uint32_t y = square.y; y < square.y + square.size; ++y) {
    for (std::uint32_t x = square.x; x < square.x + square.size; ++x) {
      const std::uint32_t index = y * size + x;
      cells_[map.begin + index / kPerWord] |= static_cast<std::uint32_t>(opacity)
                                              << index % kPerWord * kBits;
    }
  }
}

void OpacityMaps::finish() {
  meshes_.clear();
  triangles_.clear();
  bounds_.clear();
}

}  // namespace microtrace
