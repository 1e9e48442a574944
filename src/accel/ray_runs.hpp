#pragma once
/// Divides an array of rays into runs that are traced as packets or as streams.

#include "accel/kernels/kernel.hpp"
#include "accel/ray_stream.hpp"

#include <microtrace/ray.hpp>

#include <algorithm>
#include <cstddef>
#include <span>

namespace microtrace {

/// Returns the number of leading rays with a common origin, at most kPacketRays.
[[nodiscard]] inline std::size_t common_origin_length(std::span<const Ray> rays) {
  const Vec3 o = rays[0].o;
  const std::size_t limit = std::min<std::size_t>(rays.size(), kPacketRays);
  std::size_t length = 1;
  while (length < limit && rays[length].o == o) ++length;
  return length;
}

/// Fewer rays than this are traced faster one by one than as a packet or a stream.
inline constexpr std::size_t kLeastPacket = 8, kLeastStream = 8;

/// Returns the number of leading rays before the next run of kLeastPacket rays with a common
/// origin: at least 1, and at most kStreamRays.
[[nodiscard]] inline std::size_t unrelated_length(std::span<const Ray> rays) {
  const std::size_t limit = std::min<std::size_t>(rays.size(), kStreamRays);
  for (std::size_t i = 1; i + kLeastPacket <= limit; ++i) {
    if (rays[i].o == rays[i + kLeastPacket - 1].o &&
        common_origin_length(rays.subspan(i)) >= kLeastPacket)
      return i;
  }
  return limit;
}

}  // namespace microtrace
