#pragma once
/// Bounds of the alpha of textures over regions.

#include "base/memory_account.hpp"
#include "render/textures/texture_map.hpp"

#include <microtrace/math.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace microtrace {

/// A closed interval.
struct ValueInterval {
  double lo, hi;
};

/// A pyramid of the least and the greatest alpha of blocks of an image's texels. Temporary data for
/// preparing a scene.
class AlphaBounds {
 public:
  /// The image must outlive this object.
  explicit AlphaBounds(const Image& image);

  /// Contains map.sample(uv, 0).w for all float32 texture coordinates in [u.lo, u.hi] x [v.lo,
  /// v.hi], which must be within [-2^20, 2^20]. The map must be one of the image.
  [[nodiscard]] ValueInterval over(const TextureMap& map, const ValueInterval& u,
                                   const ValueInterval& v) const;

 private:
  /// The least and the greatest sample value.
  struct Values {
    std::uint16_t least = 0xffff, greatest = 0;

    void add(const Values& other) {
      least = std::min(least, other.least);
      greatest = std::max(greatest, other.greatest);
    }
  };
  /// Level k has a value for each block of 2^k x 2^k texels.
  struct Level {
    std::int64_t width;
    std::vector<Values> values;
  };
  /// An interval of texels, with both ends.
  struct Texels {
    std::int64_t first, last;
  };

  void add_level();
  [[nodiscard]] Values texel(std::int64_t x, std::int64_t y) const;
  [[nodiscard]] Values values(std::size_t level, std::int64_t x, std::int64_t y) const {
    if (level == 0) return texel(x, y);
    const Level& blocks = levels_[level - 1];
    return blocks.values[static_cast<std::size_t>(y * blocks.width + x)];
  }
  [[nodiscard]] Values over(const Texels& x, const Texels& y) const;

  const Image& image_;
  MemoryAccount memory_;
  std::vector<Level> levels_;  // from level 1 on; empty if the image has no alpha
};

}  // namespace microtrace
