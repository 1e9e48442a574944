#include "render/lights/environment/environment_light.hpp"

#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/lights/environment/map_light.hpp"
#include "render/lights/environment/studio.hpp"
#include "scene/math/luminance.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <variant>

#include <glm/common.hpp>

namespace microtrace {
namespace {

/// The maximum intensity. The product with the greatest radiance of a map, 2^30, is kBrightest.
constexpr float kGreatestIntensity = kBrightest / 0x1p30F;

constexpr float kUniformPdf = static_cast<float>(0.25 / std::numbers::pi);

/// Converts an angle to the fractional part of its revolutions, in [0, 1).
float part_of_turn(double radians) {
  const double turns = radians / (2 * std::numbers::pi);
  const auto part = static_cast<float>(turns - std::floor(turns));
  return part < 1 ? part : 0;
}

std::shared_ptr<const MapTables> studio_tables() {
  static const auto tables = std::make_shared<const MapTables>(
      std::make_shared<const RadianceMap>(make_studio()), MemoryAccount(nullptr));
  return tables;
}

}  // namespace

std::shared_ptr<const MapTables> tables_of(const Environment& environment) {
  if (std::holds_alternative<Vec3>(environment.content)) return nullptr;
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map == nullptr) return studio_tables();
  constexpr std::uint64_t kBytesOfPixel = 16;
  return std::make_shared<const MapTables>(
      *map, temporary_memory((*map)->pixels.size() * kBytesOfPixel,
                             "the sampling tables of the environment"));
}

EnvironmentLight::EnvironmentLight(const Environment& environment,
                                   std::shared_ptr<const MapTables> tables)
    : tables_(std::move(tables)), kernels_(&kShadingKernels.best()) {
  const float intensity = std::min(environment.intensity, kGreatestIntensity);
  if (tables_) {
    const MapDistribution& distribution = tables_->distribution;
    shape_ = distribution.shape();
    shape_.intensity = intensity;
    shape_.turn = part_of_turn(environment.rotation);
    shape_.back_turn = part_of_turn(-std::numbers::pi - environment.rotation);
    mean_luminance_ = static_cast<float>(distribution.mean_luminance() * double{intensity});
    sampled_luminance_ = static_cast<float>(distribution.sampled_luminance() * double{intensity});
  } else {
    uniform_ = glm::min(intensity * std::get<Vec3>(environment.content), Vec3(kBrightest));
    mean_luminance_ = luminance(uniform_);
    sampled_luminance_ = mean_luminance_ * kLeastMapPart;
  }
}

ImageSize EnvironmentLight::map_size() const {
  if (!tables_) return {.width = 1, .height = 1};
  return {.width = tables_->map->width, .height = tables_->map->height};
}

EnvironmentLight::Lookup EnvironmentLight::lookup(const Vec3& direction) const {
  if (!tables_) return {.radiance = uniform_, .pdf = kUniformPdf};
  MapLanes<1> lanes;
  put(lanes.d, 0, direction);
  find_map_places<1>(shape_, lanes);
  tables_->distribution.put_cell(0, lanes);
  look_up_map<1>(shape_, lanes);
  return {.radiance = got(lanes.radiance, 0), .pdf = lanes.pdf[0]};
}

Vec3 EnvironmentLight::radiance(const Vec3& direction) const {
  return lookup(direction).radiance;
}

void EnvironmentLight::put_uniform(MapLanes<kShadingLanes>& lanes) const {
  for (int axis = 0; axis < 3; ++axis) std::ranges::fill(lanes.radiance[axis], uniform_[axis]);
  std::ranges::fill(lanes.pdf, kUniformPdf);
}

void EnvironmentLight::look_up(Lanes lanes, MapLanes<kShadingLanes>& at) const {
  if (!tables_) return put_uniform(at);
  kernels_->find_map_places(shape_, at);
  for (Lanes rest = lanes; rest != 0; rest &= rest - 1) {
    const int lane = std::countr_zero(rest);
    tables_->distribution.prefetch(static_cast<std::uint32_t>(at.column[lane]),
                                   static_cast<std::uint32_t>(at.line[lane]));
  }
  for (Lanes rest = lanes; rest != 0; rest &= rest - 1)
    tables_->distribution.put_cell(std::countr_zero(rest), at);
  kernels_->look_up_map(shape_, at);
}

void EnvironmentLight::sample(Lanes lanes, const LaneFloats (&u)[2],
                              MapLanes<kShadingLanes>& samples) const {
  if (!tables_) {
    kernels_->sample_sphere(u, samples.d);
    put_uniform(samples);
    return;
  }
  tables_->distribution.select(lanes, u, samples);
  kernels_->sample_map(shape_, samples);
}

}  // namespace microtrace
