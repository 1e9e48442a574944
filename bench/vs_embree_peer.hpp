#pragma once
/// Embree as the reference: a scene of one mesh, and all modes of querying it with many rays.

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

/// The result of a ray: the index of a triangle, or kMiss.
struct PeerHit {
  std::uint32_t id;
  float t;
};
inline constexpr std::uint32_t kMiss = ~0U;

/// A mode of querying.
struct PeerMode {
  int width = 1;          ///< rays per call: 1, 4, 8 or 16; kStream: rtcIntersect1M
  bool coherent = false;  ///< flag of the context
};
inline constexpr int kStream = 256;  ///< rays per call of rtcIntersect1M or rtcOccluded1M
inline constexpr PeerMode kPeerModes[] = {{1, false},       {1, true},      {4, false},  {4, true},
                                          {8, false},       {8, true},      {16, false}, {16, true},
                                          {kStream, false}, {kStream, true}};

/// K rays, with one array per component in the order of RTCRayK.
template <int K>
struct alignas(4 * K) RayPacket {
  float o_x[K], o_y[K], o_z[K], t_min[K], d_x[K], d_y[K], d_z[K], t_max[K];
};

/// Rays in the layout of each mode; conversion is not part of the measured time. The last packet is
/// filled with copies of the last ray. The least positive t_min is replaced by 0, because products
/// with a denormal number are slow. The results are the same, as no ray starts on a surface.
struct PeerRays {
  explicit PeerRays(std::span<const Ray> rays);

  std::vector<Ray> single;
  std::vector<RayPacket<4>> by_4;
  std::vector<RayPacket<8>> by_8;
  std::vector<RayPacket<16>> by_16;
};

struct PeerOptions {
  std::string isa{};    ///< in the format of Embree's configuration; empty: the best for the
                        ///< processor
  bool robust = false;  ///< RTC_SCENE_FLAG_ROBUST
  RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
  unsigned threads = 1;
};

/// A scene of Embree. Throws std::runtime_error if Embree reports an error.
class PeerScene {
 public:
  /// Shares the mesh with Embree; it must outlive this object. The positions need room for one more
  /// float after the last, because Embree reads 16 bytes of each.
  PeerScene(const Mesh& mesh, const PeerOptions& options);

  /// Builds the tree; the build benchmark measures this function.
  void commit();

  /// Whether Embree uses AVX-512 on this machine.
  [[nodiscard]] bool is_16_wide() const;
  /// The memory allocated by Embree for the scene, excluding the mesh.
  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(*bytes_); }

  /// Queries rays [begin, end), where begin is a multiple of 64, and stores the results at the same
  /// indices.
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
