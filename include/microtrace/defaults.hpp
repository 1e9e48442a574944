#pragma once
/// Default settings for rendering a scene. The program uses the same settings if it is given no
/// options.

#include <microtrace/aov.hpp>
#include <microtrace/camera.hpp>
#include <microtrace/export.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/math.hpp>
#include <microtrace/path.hpp>
#include <microtrace/render.hpp>
#include <microtrace/scene.hpp>
#include <microtrace/scene_format.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

namespace microtrace {

/// Selects FlatIntegrator, which shows colors without lighting.
struct FlatOptions {};

/// Selects one of the library's integrators by the type of its options. An Aov selects
/// AovIntegrator, which shows that quantity.
///
/// To add an integrator, add its options here, its construction in src/render/defaults.cpp, its
/// name in src/cli/options/values.cpp, src/capi/pictures.cpp and python/src/pictures.cpp, its help
/// text in src/cli/options/sampling_options.cpp, and a line in docs/command-line.md.
using IntegratorOptions = std::variant<FlatOptions, PathOptions, Aov>;

[[nodiscard]] MICROTRACE_EXPORT std::unique_ptr<Integrator> make_integrator(
    const IntegratorOptions& options);

/// Returns PathOptions for glTF assets, which have materials and lights, and FlatOptions for JSON
/// scenes.
[[nodiscard]] MICROTRACE_EXPORT IntegratorOptions default_integrator(SceneFormat format);

/// Returns the default number of samples per pixel: 64 for path tracing, otherwise 1.
[[nodiscard]] MICROTRACE_EXPORT std::uint32_t default_samples(const IntegratorOptions& integrator);

/// Returns the default background in linear Rec. 709, or nothing to keep the scene's own
/// background. Path-traced glTF assets, which can't specify a background, get the gray 0.25, which
/// the default tone map shows as 127 of 255. Surfaces of reflectance 0.8, the default of many
/// programs, are about as bright as 0.6 in the studio and would vanish before a light gray.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> default_background(
    SceneFormat format, const IntegratorOptions& integrator);

/// Arguments for render(). Change them as needed.
struct RenderSettings {
  Camera camera{};   ///< the result of default_camera()
  ImageSize size{};  ///< Scene::size
  std::shared_ptr<const Integrator> integrator{};
  RenderOptions options{};  ///< refers to `integrator`; has its default samples and background
};

/// Returns the settings for a loaded scene with the default integrator or a given one.
[[nodiscard]] MICROTRACE_EXPORT RenderSettings default_settings(const Scene& scene,
                                                                SceneFormat format);
[[nodiscard]] MICROTRACE_EXPORT RenderSettings
default_settings(const Scene& scene, SceneFormat format, const IntegratorOptions& integrator);

}  // namespace microtrace
