#include "cli/arguments.hpp"

#include <microtrace/aov.hpp>
#include <microtrace/error.hpp>

#include <algorithm>

namespace microtrace::cli {
namespace {

void check_sampling(const SamplingOptions& sampling, bool is_path) {
  if (sampling.needs_passes() && !is_path) {
    refuse_usage(
        "checkpoints, --progressive, --target-error and --time-limit need path tracing; use "
        "--integrator path");
  }
  if (sampling.shard && sampling.shard->count > sampling.samples) {
    refuse_usage("--shard: " + std::to_string(sampling.samples) +
                 " samples (--spp) can't be divided into " + std::to_string(sampling.shard->count) +
                 " shards");
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

void apply_defaults(Arguments& a, SceneFormat format) {
  const bool is_gltf = format == SceneFormat::gltf;
  a.integrator = a.wanted.value_or(is_gltf ? Technique::path : Technique::flat);
  const bool is_path = a.integrator == Subject(Technique::path);
  if (a.environment.shows_environment() && !is_path)
    refuse_usage("--background: env needs path tracing; use --integrator path");
  if (!a.aovs.sampled.empty() && !is_path) {
    refuse_usage("--aov: " + std::string(name_of(a.aovs.sampled.front())) +
                 " needs path tracing; use --integrator path");
  }
  if (a.sampling.samples == 0) a.sampling.samples = is_path ? 64 : 1;
  check_sampling(a.sampling, is_path);
  // Lighter than shadows and darker than highlights, so that models stand out.
  if (is_gltf && is_path && !a.environment.background)
    a.environment.background = Background{.color = Vec3(0.6F)};
}

SurfaceDetail surface_detail(const Arguments& a) {
  const bool shows_albedo = std::ranges::find(a.aovs.exact, Aov::albedo) != a.aovs.exact.end();
  const Aov* quantity = a.wanted ? std::get_if<Aov>(&*a.wanted) : nullptr;
  if (quantity != nullptr && *quantity != Aov::albedo && !shows_albedo) return SurfaceDetail::shape;
  if (!a.aovs.empty()) return SurfaceDetail::all;
  if (!a.wanted) return SurfaceDetail::usual;
  return a.wanted == Subject(Technique::flat) ? SurfaceDetail::color : SurfaceDetail::all;
}

std::unique_ptr<Integrator> make_integrator(const Arguments& arguments) {
  if (const auto* aov = std::get_if<Aov>(&arguments.integrator))
    return std::make_unique<AovIntegrator>(*aov);
  if (std::get<Technique>(arguments.integrator) == Technique::path)
    return std::make_unique<PathIntegrator>(arguments.path);
  return std::make_unique<FlatIntegrator>();
}

}  // namespace microtrace::cli
