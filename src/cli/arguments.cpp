#include "cli/arguments.hpp"

#include "base/counted.hpp"
#include "cli/options/applicable.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/defaults.hpp>
#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>

#include <algorithm>

namespace microtrace::cli {
namespace {

/// Applies --quality to options that are not given.
void apply_quality(SamplingOptions& sampling) {
  if (sampling.quality == nullptr) return;
  if (sampling.samples == 0) sampling.samples = sampling.quality->samples;
  if (sampling.target_error == 0 && !sampling.shard)
    sampling.target_error = sampling.quality->target_error;
}

void check_sampling(const SamplingOptions& sampling, bool is_path) {
  if (sampling.uses_files() && !is_path)
    refuse_usage("checkpoints and --progressive need path tracing; use --integrator path");
  if (sampling.shard && sampling.shard->count > sampling.samples) {
    refuse_usage("--shard: " + counted(sampling.samples, "sample") +
                 " (--spp) can't be divided into " + std::to_string(sampling.shard->count) +
                 " shards");
  }
}

void check_shutter(const Arguments& a) {
  if (!a.shutter) return;
  if (!a.is_path_traced())
    refuse_usage("--shutter: motion blur needs path tracing; use --integrator path");
  if (a.denoises) refuse_usage("--denoise can't be combined with --shutter; omit one of them");
  for (const SampledAov aov : kDenoiseFeatures) {
    if (std::ranges::find(a.aovs.sampled, aov) == a.aovs.sampled.end()) continue;
    refuse_usage("--aov: " + std::string(name_of(aov)) +
                 " can't be combined with --shutter; omit one of them");
  }
}

}  // namespace

View CameraOptions::view() const {
  View view = orbit.value_or(OrbitView{}).view;
  view.vertical_fov = vertical_fov.value_or(view.vertical_fov);
  return view;
}

std::optional<SampleRange> SamplingOptions::range() const {
  if (!shard) return std::nullopt;
  const auto bound = [&](std::uint32_t index) {
    return static_cast<std::uint32_t>(std::uint64_t{samples} * index / shard->count);
  };
  return SampleRange{.first = bound(shard->index - 1), .last = bound(shard->index)};
}

void choose_integrator(Arguments& a, SceneFormat format) {
  if (!a.integrator) a.integrator = default_integrator(format);
}

void apply_defaults(Arguments& a, SceneFormat format) {
  choose_integrator(a, format);
  if (a.is_path_traced()) a.integrator = a.path;
  check_applicable(a);
  apply_quality(a.sampling);
  if (a.sampling.samples == 0) a.sampling.samples = default_samples(*a.integrator);
  check_sampling(a.sampling, a.is_path_traced());
  check_shutter(a);
  if (!a.display.exposure && a.display.automatic == AutomaticExposure::never &&
      format == SceneFormat::gltf && a.is_path_traced())
    a.display.automatic = AutomaticExposure::for_lights;
  const std::optional<Vec3> color = default_background(format, *a.integrator);
  if (color && !a.environment.background) a.environment.background = Background{.color = *color};
}

SurfaceDetail surface_detail(const Arguments& a) {
  if (!a.integrator) return a.aovs.empty() ? SurfaceDetail::usual : SurfaceDetail::all;
  if (a.is_path_traced()) return SurfaceDetail::all;
  const bool shows_albedo = std::ranges::find(a.aovs.exact, Aov::albedo) != a.aovs.exact.end();
  const Aov* quantity = std::get_if<Aov>(&*a.integrator);
  if (quantity != nullptr && *quantity != Aov::albedo && !shows_albedo) return SurfaceDetail::shape;
  const bool is_flat = quantity == nullptr;
  return is_flat && a.aovs.empty() ? SurfaceDetail::color : SurfaceDetail::shape_and_color;
}

}  // namespace microtrace::cli
