#pragma once
/// Default settings for rendering a scene. The program without options uses them too.

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

/// Colors without light, by FlatIntegrator.
struct FlatOptions {};

/// An integrator of the library and its options. An Aov is a picture of that quantity.
///
/// To add one: its options here, its integrator in src/render/defaults.cpp, its name in
/// src/cli/options/values.cpp and src/capi/pictures.cpp, its help text in
/// src/cli/options/sampling_options.cpp, a line in docs/command-line.md.
using IntegratorOptions = std::variant<FlatOptions, PathOptions, Aov>;

[[nodiscard]] MICROTRACE_EXPORT std::unique_ptr<Integrator> make_integrator(
    const IntegratorOptions& options);

/// glTF assets, which have materials and lights, are path traced; JSON scenes show flat colors.
[[nodiscard]] MICROTRACE_EXPORT IntegratorOptions default_integrator(SceneFormat format);

/// Samples per pixel: 64 for path tracing, else 1.
[[nodiscard]] MICROTRACE_EXPORT std::uint32_t default_samples(const IntegratorOptions& integrator);

/// Linear Rec. 709; nothing means the scene's own. Path-traced glTF assets, which can't specify a
/// background, get gray: lighter than shadows and darker than highlights.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> default_background(
    SceneFormat format, const IntegratorOptions& integrator);

/// Arguments of render(), to be changed as needed.
struct RenderSettings {
  Camera camera{};   ///< default_camera
  ImageSize size{};  ///< Scene::size
  std::shared_ptr<const Integrator> integrator{};
  RenderOptions options{};  ///< with the integrator, its samples and the default background
};

/// The settings for a loaded scene with the default integrator or a given one.
[[nodiscard]] MICROTRACE_EXPORT RenderSettings default_settings(const Scene& scene,
                                                                SceneFormat format);
[[nodiscard]] MICROTRACE_EXPORT RenderSettings
default_settings(const Scene& scene, SceneFormat format, const IntegratorOptions& integrator);

}  // namespace microtrace
