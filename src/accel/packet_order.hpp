#pragma once
/// The order of rays in a packet.

#include "accel/kernels/kernel.hpp"

#include <microtrace/ray.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <glm/common.hpp>

namespace microtrace {

/// The index of the ray at each place of a packet.
using PacketOrder = std::array<std::uint8_t, kPacketRays>;

template <class F>
constexpr PacketOrder make_packet_order(const F& ray_at) {
  PacketOrder order{};
  for (std::size_t place = 0; place < order.size(); ++place)
    order[place] = static_cast<std::uint8_t>(ray_at(place));
  return order;
}

inline constexpr PacketOrder kGivenOrder = make_packet_order([](std::size_t i) { return i; });

/// The order in which each group is a square of 4 x 4 pixels, for rays of 8 x 8 pixels row by row.
inline constexpr PacketOrder kSquareOrder = make_packet_order([](std::size_t i) {
  static_assert(kPacketRays == 64 && kGroupRays == 16);
  const std::size_t square = i / 16, row = i % 16 / 4, column = i % 4;
  return (square / 2 * 4 + row) * 8 + square % 2 * 4 + column;
});

/// The order in which small boxes are entered by few groups. This is a guess, which affects only
/// the speed.
[[nodiscard]] inline const PacketOrder& best_order(std::span<const Ray> rays) {
  if (rays.size() != kPacketRays) return kGivenOrder;
  const auto distance = [&](std::size_t i, std::size_t k) {
    const Vec3 difference = glm::abs(rays[i].d - rays[k].d);
    return difference.x + difference.y + difference.z;
  };
  // A row of eight pixels is seven steps long, and the next row is a step away.
  const bool has_rows = 4 * distance(0, 8) < distance(0, 7) &&
                        4 * distance(7, 15) < distance(8, 15) &&
                        4 * distance(55, 63) < distance(56, 63);
  return has_rows ? kSquareOrder : kGivenOrder;
}

}  // namespace microtrace
