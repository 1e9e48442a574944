// Compares packets and streams of rays with single rays, in the portable kernels. A build for
// AArch64 runs under emulation, because faults of its compiler don't show in the kernels for
// x86-64.

#include "accel/kernels/kernel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <random>

namespace microtrace {

extern const Kernels kPortableKernels;

namespace {

constexpr std::size_t kBlocks = 8;
constexpr float kInfinity = std::numeric_limits<float>::infinity();

class Random {
 public:
  /// A number between -1 and 1.
  float signed_unit() { return static_cast<float>(bits_() >> 8U) * 0x1p-23F - 1; }

 private:
  std::mt19937 bits_{1};
};

/// Blocks of random triangles in the cube from -1 to 1.
std::array<TriangleBlock, kBlocks> random_blocks(Random& random) {
  std::array<TriangleBlock, kBlocks> blocks{};
  for (std::size_t i = 0; i < kBlocks; ++i) {
    TriangleBlock& block = blocks[i];
    constexpr unsigned kNone = TriangleBlock::kVertices - 1;
    for (auto& axis : block.vertices) axis[kNone] = std::numeric_limits<float>::quiet_NaN();
    for (auto& corners : block.corners) std::fill_n(corners, kWidth, std::uint8_t{kNone});
    for (unsigned slot = 0; slot < TriangleBlock::kUnshared; ++slot) {
      block.id[slot] = static_cast<std::uint32_t>(i * kWidth + slot);
      for (unsigned corner = 0; corner < 3; ++corner)
        block.corners[corner][slot] = static_cast<std::uint8_t>(3 * slot + corner);
      for (auto& axis : block.vertices) {
        const float middle = random.signed_unit();
        for (unsigned corner = 0; corner < 3; ++corner)
          axis[3 * slot + corner] = middle + 0.3F * random.signed_unit();
      }
    }
    block.largest_edge = 1;
    block.edge_product = 1;
  }
  return blocks;
}

/// A result for each of kPacketRays rays.
struct Results {
  std::array<ClosestSoFar, kPacketRays> hits{};
  std::array<bool, kPacketRays> undecided{};  ///< true if a fallback had to decide
};

struct Rays {
  float o[3];
  std::array<std::array<float, 3>, kPacketRays> d;

  /// Rays of 8 x 8 pixels toward a random point of the cube.
  explicit Rays(Random& random) {
    const float size = std::exp2(3 * random.signed_unit() - 5);
    float middle[3];
    for (int axis = 0; axis < 3; ++axis) {
      o[axis] = 2 * random.signed_unit() + (axis == 2 ? 4.0F : 0.0F);
      middle[axis] = random.signed_unit() - o[axis];
    }
    for (std::size_t i = 0; i < d.size(); ++i)
      d[i] = {middle[0] + size * static_cast<float>(i % 8),
              middle[1] - size * static_cast<float>(i / 8), middle[2]};
  }
};

/// The rays as eight numbers each, as kernels read them.
using Numbers = std::array<std::array<float, 8>, kPacketRays>;
Numbers numbers_of(const Rays& rays) {
  Numbers numbers{};
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    std::copy_n(rays.o, 3, numbers[i].data());
    std::copy_n(rays.d[i].data(), 3, numbers[i].data() + 4);
    numbers[i][7] = kInfinity;
  }
  return numbers;
}

Results one_by_one(const TreeView& tree, const Rays& rays) {
  Results results;
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    KernelRay ray{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ray.o[axis] = rays.o[axis];
      ray.d[axis] = rays.d[i][axis];
    }
    ray.t_max = kInfinity;
    ray.omitted_id = kNoPrimitive;
    results.hits[i] = {.lo = kInfinity, .hi = kInfinity, .id = kNoPrimitive};
    kPortableKernels.closest(
        tree, ray,
        {.context = &results.undecided[i],
         .consider = [](void* undecided, std::uint32_t,
                        ClosestSoFar&) { *static_cast<bool*>(undecided) = true; }},
        results.hits[i]);
  }
  return results;
}

Results as_packet(const TreeView& tree, const Rays& rays) {
  // Squares of 4 x 4 pixels.
  std::uint8_t order[kPacketRays];
  for (unsigned i = 0; i < kPacketRays; ++i)
    order[i] = static_cast<std::uint8_t>((i / 32 * 4 + i % 16 / 4) * 8 + i / 16 % 2 * 4 + i % 4);
  const Numbers numbers = numbers_of(rays);
  Results places, results;
  const auto packet = std::make_unique<KernelPacket>();
  packet->order = order;
  if (!kPortableKernels.fill_packet(numbers[0].data(), kPacketRays, *packet))
    std::puts("a packet is refused");
  kPortableKernels.closest_of_packet(
      tree, *packet,
      {.context = &places,
       .consider =
           [](void* of, int ray, std::uint32_t, ClosestSoFar&) {
             static_cast<Results*>(of)->undecided[static_cast<std::size_t>(ray)] = true;
           },
       .consider_all = nullptr});
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    results.hits[order[i]] = {packet->best_lo[i], packet->best_hi[i], packet->best_id[i]};
    results.undecided[order[i]] = places.undecided[i];
  }
  return results;
}

Results as_stream(const TreeView& tree, const Rays& rays) {
  const auto stream = std::make_unique<KernelStream>();
  stream->count = kPacketRays;
  const Numbers numbers = numbers_of(rays);
  kPortableKernels.read_stream(numbers[0].data(), *stream);
  std::fill_n(stream->omitted_id, kPacketRays, kNoPrimitive);
  Results results;
  kPortableKernels.prepare_stream(*stream);
  kPortableKernels.closest_of_stream(
      tree, *stream,
      {.context = &results, .consider = [](void* of, int ray, std::uint32_t, ClosestSoFar&) {
         static_cast<Results*>(of)->undecided[static_cast<std::size_t>(ray)] = true;
       }});
  for (std::size_t i = 0; i < kPacketRays; ++i)
    results.hits[i] = {stream->best_lo[i], stream->best_hi[i], stream->best_id[i]};
  return results;
}

/// The counts of rays.
struct Counts {
  int hits = 0, undecided = 0, different = 0;
};

void compare(const Results& expected, const Results& found, Counts& counts) {
  for (std::size_t i = 0; i < kPacketRays; ++i) {
    const ClosestSoFar &a = expected.hits[i], &b = found.hits[i];
    if (expected.undecided[i] || found.undecided[i]) {
      ++counts.undecided;
    } else {
      counts.hits += a.id != kNoPrimitive ? 1 : 0;
      counts.different +=
          a.id != b.id || (a.id != kNoPrimitive && (a.lo > b.hi || b.lo > a.hi)) ? 1 : 0;
    }
  }
}

/// Returns false if results differ, or if too few rays can be compared.
bool check() {
  Random random;
  Counts packets, streams;
  int rays = 0;
  for (int round = 0; round < 500; ++round) {
    const auto blocks = random_blocks(random);
    const TreeView tree{.nodes = nullptr,
                        .blocks = blocks.data(),
                        .others = nullptr,
                        .root = child_ref::kTriangles | (kBlocks - 1)};
    const Rays some(random);
    const Results expected = one_by_one(tree, some);
    compare(expected, as_packet(tree, some), packets);
    compare(expected, as_stream(tree, some), streams);
    rays += kPacketRays;
  }
  bool is_good = true;
  for (const auto& [name, counts] :
       {std::pair("packets", packets), std::pair("streams", streams)}) {
    std::printf("%s: %d rays, %d hits, %d undecided, %d different\n", name, rays, counts.hits,
                counts.undecided, counts.different);
    is_good &= counts.different == 0 && counts.hits > rays / 8 && counts.undecided < rays / 50;
  }
  return is_good;
}

}  // namespace
}  // namespace microtrace

int main() {
  return microtrace::check() ? 0 : 1;
}
