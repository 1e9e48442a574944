#pragma once
/// Wraps Embree: a scene with one mesh, and all modes of tracing many rays.

#include <microtrace/ray.hpp>
#include <microtrace/scene.hpp>
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

/// The nearest hit of a ray. `id` is the index of a triangle, or kMiss.
struct PeerHit {
  std::uint32_t id;
  float t;
};
inline constexpr std::uint32_t kMiss = ~0U;

/// A mode of tracing many rays.
struct PeerMode {
  int width = 1;  ///< rays per call: 1, 4, 8 or 16; kStream for rtcIntersect1M and rtcOccluded1M
  bool coherent = false;  ///< sets the context's flag for coherent rays
};
inline constexpr int kStream = 256;  ///< rays per call of rtcIntersect1M or rtcOccluded1M
inline constexpr PeerMode kPeerModes[] = {{1, false},       {1, true},      {4, false},  {4, true},
                                          {8, false},       {8, true},      {16, false}, {16, true},
                                          {kStream, false}, {kStream, true}};

/// K rays, with one array per component. The order of components is that of RTCRayK.
template <int K>
struct alignas(4 * K) RayPacket {
  float o_x[K], o_y[K], o_z[K], t_min[K], d_x[K], d_y[K], d_z[K], t_max[K];
};

/// Rays in the layouts of all modes. The conversion is not part of the measured time. The last
/// packet is filled up with copies of the last ray. A t_min equal to the least positive number is
/// replaced by 0, because products with denormal numbers are slow. This doesn't change results,
/// because no ray starts on a surface.
struct PeerRays {
  explicit PeerRays(std::span<const Ray> rays);

  std::vector<Ray> single;
  std::vector<RayPacket<4>> by_4;
  std::vector<RayPacket<8>> by_8;
  std::vector<RayPacket<16>> by_16;
};

struct PeerOptions {
  std::string isa{};    ///< in the format of Embree's configuration; empty: the processor's best
  bool robust = false;  ///< RTC_SCENE_FLAG_ROBUST
  RTCBuildQuality quality = RTC_BUILD_QUALITY_HIGH;
  unsigned threads = 1;
};

/// An Embree scene. Throws std::runtime_error if Embree reports an error.
class PeerScene {
 public:
  /// Shares the scene's meshes with Embree, so it must outlive this object. Placed meshes, which
  /// must all be the same one, become instances. The memory of positions must extend one float past
  /// the last one, because Embree reads 16 bytes for each position.
  PeerScene(const Scene& scene, const PeerOptions& options);

  /// Builds the tree; the build benchmark measures this function.
  void commit();

  /// Returns true if Embree supports packets of 16 rays on this machine, which requires AVX-512.
  [[nodiscard]] bool is_16_wide() const;
  /// Returns the memory allocated by Embree for the scene, excluding the mesh.
  [[nodiscard]] std::size_t bytes() const { return static_cast<std::size_t>(*bytes_); }

  /// Traces the rays [begin, end) and stores their results at the same indices. begin must be a
  /// multiple of 64.
  void intersect(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                 std::span<PeerHit> hits) const;
  void occluded(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                std::span<std::uint8_t> hits) const;

 private:
  void attach(const Mesh& mesh, RTCScene scene) const;

  struct Release {
    void operator()(RTCDevice device) const { rtcReleaseDevice(device); }
    void operator()(RTCScene scene) const { rtcReleaseScene(scene); }
  };
  template <class T>
  using Owner = std::unique_ptr<std::remove_pointer_t<T>, Release>;

  std::unique_ptr<std::atomic<std::ptrdiff_t>> bytes_;
  Owner<RTCDevice> device_;
  Owner<RTCScene> scene_, shared_;  // shared_ holds the mesh of instances; null without instances
  std::vector<std::uint32_t> first_ids_;  // of each object
};

}  // namespace microtrace::bench
