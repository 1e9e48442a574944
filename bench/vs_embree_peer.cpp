#include "vs_embree_peer.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace microtrace::bench {
namespace {

// Embree's types and functions for packets of K rays.
template <int K>
struct Calls;
template <>
struct Calls<4> {
  using Ray = RTCRay4;
  using RayHit = RTCRayHit4;
  static constexpr auto* kIntersect = rtcIntersect4;
  static constexpr auto* kOccluded = rtcOccluded4;
};
template <>
struct Calls<8> {
  using Ray = RTCRay8;
  using RayHit = RTCRayHit8;
  static constexpr auto* kIntersect = rtcIntersect8;
  static constexpr auto* kOccluded = rtcOccluded8;
};
template <>
struct Calls<16> {
  using Ray = RTCRay16;
  using RayHit = RTCRayHit16;
  static constexpr auto* kIntersect = rtcIntersect16;
  static constexpr auto* kOccluded = rtcOccluded16;
};

template <int K>
std::vector<RayPacket<K>> pack(std::span<const Ray> rays) {
  std::vector<RayPacket<K>> packets((rays.size() + K - 1) / K);
  for (std::size_t i = 0; i < packets.size() * K; ++i) {
    const Ray& ray = rays[std::min(i, rays.size() - 1)];
    RayPacket<K>& packet = packets[i / K];
    const std::size_t k = i % K;
    packet.o_x[k] = ray.o.x;
    packet.o_y[k] = ray.o.y;
    packet.o_z[k] = ray.o.z;
    packet.t_min[k] = ray.t_min;
    packet.d_x[k] = ray.d.x;
    packet.d_y[k] = ray.d.y;
    packet.d_z[k] = ray.d.z;
    packet.t_max[k] = ray.t_max;
  }
  return packets;
}

// Sets the members of a packet that don't depend on its rays.
template <int K>
void clear(typename Calls<K>::Ray& to) {
  to = {};
  std::fill_n(to.mask, K, ~0U);
}

template <int K>
void copy(const RayPacket<K>& from, typename Calls<K>::Ray& to) {
  std::memcpy(to.org_x, from.o_x, sizeof from.o_x);
  std::memcpy(to.org_y, from.o_y, sizeof from.o_y);
  std::memcpy(to.org_z, from.o_z, sizeof from.o_z);
  std::memcpy(to.tnear, from.t_min, sizeof from.t_min);
  std::memcpy(to.dir_x, from.d_x, sizeof from.d_x);
  std::memcpy(to.dir_y, from.d_y, sizeof from.d_y);
  std::memcpy(to.dir_z, from.d_z, sizeof from.d_z);
  std::memcpy(to.tfar, from.t_max, sizeof from.t_max);
}

RTCRay single(const Ray& ray) {
  return {.org_x = ray.o.x,
          .org_y = ray.o.y,
          .org_z = ray.o.z,
          .tnear = ray.t_min,
          .dir_x = ray.d.x,
          .dir_y = ray.d.y,
          .dir_z = ray.d.z,
          .time = 0,
          .tfar = ray.t_max,
          .mask = ~0U,
          .id = 0,
          .flags = 0};
}

RTCIntersectContext context_of(PeerMode mode) {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags =
      mode.coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
  return context;
}

/// A hit in Embree's numbers.
struct Numbers {
  unsigned instance, geometry, primitive;
};

PeerHit hit_of(const Numbers& hit, std::span<const std::uint32_t> first_ids, float t) {
  if (hit.geometry == RTC_INVALID_GEOMETRY_ID) return {kMiss, t};
  const bool is_instance = hit.instance != RTC_INVALID_GEOMETRY_ID;
  return {first_ids[is_instance ? hit.instance : hit.geometry] + hit.primitive, t};
}

// Calls f(first ray, number of rays) for each packet of [begin, end).
template <class F>
void for_each_packet(std::size_t begin, std::size_t end, std::size_t width, F f) {
  for (std::size_t i = begin; i < end; i += width) f(i, std::min(width, end - i));
}

template <int K>
void intersect_packets(RTCScene scene, PeerMode mode, std::span<const RayPacket<K>> packets,
                       std::size_t begin, std::size_t end, std::span<const std::uint32_t> first_ids,
                       std::span<PeerHit> hits) {
  alignas(64) std::array<int, K> valid;
  valid.fill(-1);
  alignas(64) typename Calls<K>::RayHit query{};
  clear<K>(query.ray);
  RTCIntersectContext context = context_of(mode);
  for_each_packet(begin, end, K, [&](std::size_t first, std::size_t n) {
    copy<K>(packets[first / K], query.ray);
    std::fill_n(query.hit.geomID, K, RTC_INVALID_GEOMETRY_ID);
    std::fill_n(query.hit.instID[0], K, RTC_INVALID_GEOMETRY_ID);
    Calls<K>::kIntersect(valid.data(), scene, &context, &query);
    for (std::size_t k = 0; k < n; ++k)
      hits[first + k] = hit_of({query.hit.instID[0][k], query.hit.geomID[k], query.hit.primID[k]},
                               first_ids, query.ray.tfar[k]);
  });
}

// Embree marks an occluded ray by t_far = -infinity.
template <int K>
void occlude_packets(RTCScene scene, PeerMode mode, std::span<const RayPacket<K>> packets,
                     std::size_t begin, std::size_t end, std::span<std::uint8_t> hits) {
  alignas(64) std::array<int, K> valid;
  valid.fill(-1);
  alignas(64) typename Calls<K>::Ray query;
  clear<K>(query);
  RTCIntersectContext context = context_of(mode);
  for_each_packet(begin, end, K, [&](std::size_t first, std::size_t n) {
    copy<K>(packets[first / K], query);
    Calls<K>::kOccluded(valid.data(), scene, &context, &query);
    for (std::size_t k = 0; k < n; ++k) hits[first + k] = query.tfar[k] < 0;
  });
}

void count_bytes(std::atomic<std::ptrdiff_t>& sum, std::ptrdiff_t bytes) {
  sum.fetch_add(bytes, std::memory_order_relaxed);
}

}  // namespace

PeerRays::PeerRays(std::span<const Ray> rays) : single(rays.begin(), rays.end()) {
  for (Ray& ray : single) {
    if (ray.t_min == std::numeric_limits<float>::denorm_min()) ray.t_min = 0;
  }
  by_4 = pack<4>(single);
  by_8 = pack<8>(single);
  by_16 = pack<16>(single);
}

PeerScene::PeerScene(const Scene& scene, const PeerOptions& options)
    : bytes_(std::make_unique<std::atomic<std::ptrdiff_t>>(0)) {
  const std::string configuration = "threads=" + std::to_string(options.threads) +
                                    (options.isa.empty() ? "" : ",isa=" + options.isa);
  device_.reset(rtcNewDevice(configuration.c_str()));
  if (!device_) throw std::runtime_error("Embree has no device for " + configuration);
  rtcSetDeviceMemoryMonitorFunction(
      device_.get(),
      [](void* sum, ssize_t bytes, bool) {
        count_bytes(*static_cast<std::atomic<std::ptrdiff_t>*>(sum), bytes);
        return true;
      },
      bytes_.get());
  const auto make_scene = [&] {
    RTCScene made = rtcNewScene(device_.get());
    rtcSetSceneBuildQuality(made, options.quality);
    rtcSetSceneFlags(made, options.robust ? RTC_SCENE_FLAG_ROBUST : RTC_SCENE_FLAG_NONE);
    return made;
  };
  scene_.reset(make_scene());
  std::uint32_t first_id = 0;
  for (const Object& object : scene.objects) {
    const auto& mesh = std::get<Mesh>(object.shape);
    first_ids_.push_back(first_id);
    first_id += static_cast<std::uint32_t>(mesh.triangles.size());
    if (!mesh.placement) {
      attach(mesh, scene_.get());
      continue;
    }
    if (!shared_) {
      shared_.reset(make_scene());
      attach(mesh, shared_.get());
    }
    std::array<float, 12> columns;
    for (int k = 0; k < 12; ++k)
      columns[static_cast<std::size_t>(k)] =
          static_cast<float>(mesh.placement->column(k / 3)[k % 3]);
    RTCGeometry instance = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_INSTANCE);
    rtcSetGeometryInstancedScene(instance, shared_.get());
    rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns.data());
    rtcCommitGeometry(instance);
    rtcAttachGeometry(scene_.get(), instance);
    rtcReleaseGeometry(instance);
  }
}

void PeerScene::attach(const Mesh& mesh, RTCScene scene) const {
  if (!mesh.positions.is_borrowed())
    throw std::runtime_error("Embree needs room behind the last position");
  RTCGeometry geometry = rtcNewGeometry(device_.get(), RTC_GEOMETRY_TYPE_TRIANGLE);
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                             mesh.positions.data(), 0, sizeof(Vec3), mesh.positions.size());
  rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                             mesh.triangles.data(), 0, sizeof mesh.triangles[0],
                             mesh.triangles.size());
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene, geometry);
  rtcReleaseGeometry(geometry);
}

void PeerScene::commit() {
  if (shared_) rtcCommitScene(shared_.get());
  rtcCommitScene(scene_.get());
  if (rtcGetDeviceError(device_.get()) != RTC_ERROR_NONE)
    throw std::runtime_error("Embree could not build the scene");
}

bool PeerScene::is_16_wide() const {
  return rtcGetDeviceProperty(device_.get(), RTC_DEVICE_PROPERTY_NATIVE_RAY16_SUPPORTED) != 0;
}

void PeerScene::intersect(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                          std::span<PeerHit> hits) const {
  RTCScene scene = scene_.get();
  if (mode.width == 4)
    return intersect_packets<4>(scene, mode, rays.by_4, begin, end, first_ids_, hits);
  if (mode.width == 8)
    return intersect_packets<8>(scene, mode, rays.by_8, begin, end, first_ids_, hits);
  if (mode.width == 16)
    return intersect_packets<16>(scene, mode, rays.by_16, begin, end, first_ids_, hits);
  RTCIntersectContext context = context_of(mode);
  alignas(64) std::array<RTCRayHit, kStream> queries{};
  const auto width = static_cast<std::size_t>(mode.width);
  for_each_packet(begin, end, width, [&](std::size_t first, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) {
      queries[k].ray = single(rays.single[first + k]);
      queries[k].hit.geomID = queries[k].hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    }
    if (width == 1)
      rtcIntersect1(scene, &context, queries.data());
    else
      rtcIntersect1M(scene, &context, queries.data(), static_cast<unsigned>(n), sizeof(RTCRayHit));
    for (std::size_t k = 0; k < n; ++k)
      hits[first + k] =
          hit_of({queries[k].hit.instID[0], queries[k].hit.geomID, queries[k].hit.primID},
                 first_ids_, queries[k].ray.tfar);
  });
}

void PeerScene::occluded(PeerMode mode, const PeerRays& rays, std::size_t begin, std::size_t end,
                         std::span<std::uint8_t> hits) const {
  RTCScene scene = scene_.get();
  // In Embree 3.13.5, coherent packets of occlusion rays never return from a scene with instances.
  if (shared_) mode.coherent = false;
  if (mode.width == 4) return occlude_packets<4>(scene, mode, rays.by_4, begin, end, hits);
  if (mode.width == 8) return occlude_packets<8>(scene, mode, rays.by_8, begin, end, hits);
  if (mode.width == 16) return occlude_packets<16>(scene, mode, rays.by_16, begin, end, hits);
  RTCIntersectContext context = context_of(mode);
  alignas(64) std::array<RTCRay, kStream> queries;
  const auto width = static_cast<std::size_t>(mode.width);
  for_each_packet(begin, end, width, [&](std::size_t first, std::size_t n) {
    for (std::size_t k = 0; k < n; ++k) queries[k] = single(rays.single[first + k]);
    if (width == 1)
      rtcOccluded1(scene, &context, queries.data());
    else
      rtcOccluded1M(scene, &context, queries.data(), static_cast<unsigned>(n), sizeof(RTCRay));
    for (std::size_t k = 0; k < n; ++k) hits[first + k] = queries[k].tfar < 0;
  });
}

}  // namespace microtrace::bench
