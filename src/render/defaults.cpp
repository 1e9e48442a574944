#include <microtrace/defaults.hpp>
#include <microtrace/framing.hpp>

namespace microtrace {
namespace {

struct MakeIntegrator {
  std::unique_ptr<Integrator> operator()(const FlatOptions& /*options*/) const {
    return std::make_unique<FlatIntegrator>();
  }
  std::unique_ptr<Integrator> operator()(const PathOptions& options) const {
    return std::make_unique<PathIntegrator>(options);
  }
  std::unique_ptr<Integrator> operator()(Aov aov) const {
    return std::make_unique<AovIntegrator>(aov);
  }
};

}  // namespace

std::unique_ptr<Integrator> make_integrator(const IntegratorOptions& options) {
  return std::visit(MakeIntegrator{}, options);
}

IntegratorOptions default_integrator(SceneFormat format) {
  if (format == SceneFormat::gltf) return PathOptions{};
  return FlatOptions{};
}

std::uint32_t default_samples(const IntegratorOptions& integrator) {
  return std::holds_alternative<PathOptions>(integrator) ? 64 : 1;
}

std::optional<Vec3> default_background(SceneFormat format, const IntegratorOptions& integrator) {
  const bool is_path = std::holds_alternative<PathOptions>(integrator);
  if (format == SceneFormat::gltf && is_path) return Vec3(0.25F);
  return std::nullopt;
}

RenderSettings default_settings(const Scene& scene, SceneFormat format,
                                const IntegratorOptions& integrator) {
  RenderSettings settings{.camera = default_camera(scene, scene.size),
                          .size = scene.size,
                          .integrator = make_integrator(integrator)};
  settings.options.integrator = settings.integrator.get();
  settings.options.samples = default_samples(integrator);
  settings.options.background = default_background(format, integrator);
  return settings;
}

RenderSettings default_settings(const Scene& scene, SceneFormat format) {
  return default_settings(scene, format, default_integrator(format));
}

}  // namespace microtrace
