#pragma once
/// Embree as the peer: a scene of one mesh, and every way to ask it about many rays.

#include <microtrace/ray.hpp>
#include <microtrace/shape.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <embree3/rtcore.h>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace microtrace::bench {

/// What a ray met: the index of a triangle, or kMiss.
struct PeerHit {
  std::uint32_t id;
  float t;
};
inline constexpr std::uint32_t kMiss = ~0U;

/// A way to ask.
struct PeerMode {
  int width = 1;          ///< rays of a call: 1, 4, 8 or 16; kStream: rtcIntersect1M
  bool coherent = false;  ///< the context's flag
};
inline constexpr int kStream = 256;  ///< rays of one call to rtcIntersect1M or rtcOccluded1M
inline constexpr PeerMode kPeerModes[] = {{1, false},       {1, true},      {4, false},  {4, true},
                                          {8, false},       {8, true},      {16, false}, {16, true},
                                          {kStream, false}, {kStream, true}};

/// K rays, an array for each part in the order of RTCRayK.
template <int K>
struct alignas(4 * K) RayPacket {
  float o_x[K], o_y[K], o_z[K], t_min[K], d_x[K], d_y[K], d_z[K], t_max[K];
};

/// Rays laid out as each mode likes them, which is not part of the time measured. The last packet
/// is filled up with copies of the last ray. The least t_min > 0 becomes 0: products with a
/// denormal number are slow. The answers are the same, as no ray starts on a surface.
struct PeerRays {
  explicit PeerRays(std::span<const Ray> rays);

  std::vector<Ray> single;
  std::vector<RayPacket<4>> by_4;
  std::vector<RayPacket<8>> by_8;
  std::vector<RayPacket<16>> by_16;
};

struct PeerOptions {
  std::string isa{};    ///< as Embree's configuration has it; empty: the processor's best
  bool robust = false;  ///< RTC_SCENE_FLAG_ROBUST
  RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
  unsigned threads = 1;
};

/// An Embree scene. Throws std::runtime_error where Embree reports an error.
class PeerScene {
 public:
  /// The mesh is shared with Embree and must outlive this. Its positions need room for one more
  /// float behind the last, as Embree reads 16 bytes of each.
  PeerScene(const Mesh& mesh, const PeerOptions& options);

  /// Builds the tree; what the build benchmark measures.
  void commit();

  /// Whether Embree runs AVX-512 here.
  [[nodiscard]] bool is_16_wide() const;
  /// What Embree has allocated for the scene, without the mesh.
  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(*bytes_); }

  /// Rays [begin, end), begin a multiple of 64; answers go to the same places.
  void intersect(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                 std::span<PeerHit> hits) const;
  void occluded(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                std::span<std::uint8_t> hits) const;

 private:
  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  template <class T>
  using Owner = std::unique_ptr<std::remove_pointer_t<T>, Release>;

  std::unique_ptr<std::atomic<std::ptrdiff_t>> bytes_;
  Owner<RTCDevice> device_;
  Owner<RTCScene> scene_;
};

}  // namespace microtrace::bench
