#pragma once
/// How a scene is rendered unless its user asks for something else. The program without options
/// does the same.

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
/// To add one: its options here, its case in make_integrator, its name in
/// src/cli/options/values.cpp.
using IntegratorOptions = std::variant<FlatOptions, PathOptions, Aov>;

[[nodiscard]] MICROTRACE_EXPORT std::unique_ptr<Integrator> make_integrator(
    const IntegratorOptions& options);

/// glTF assets, which have materials and lights, are path traced; JSON scenes show flat colors.
[[nodiscard]] MICROTRACE_EXPORT IntegratorOptions default_integrator(SceneFormat format);

/// Samples per pixel: 64 for path tracing, else 1.
[[nodiscard]] MICROTRACE_EXPORT std::uint32_t default_samples(const IntegratorOptions& integrator);

/// Linear Rec. 709; nothing: the scene's own. Path-traced glTF assets, which can't name a
/// background, are in front of gray: lighter than shadows and darker than highlights.
[[nodiscard]] MICROTRACE_EXPORT std::optional<Vec3> default_background(
    SceneFormat format, const IntegratorOptions& integrator);

/// Arguments of render(), to be changed as needed.
struct RenderSettings {
  Camera camera{};   ///< default_camera
  ImageSize size{};  ///< Scene::size
  std::shared_ptr<const Integrator> integrator{};
  RenderOptions options{};  ///< with the integrator, its samples and the default background
};

/// The settings for a loaded scene, and for a given integrator if it is not the default one.
[[nodiscard]] MICROTRACE_EXPORT RenderSettings default_settings(const Scene& scene,
                                                                SceneFormat format);
[[nodiscard]] MICROTRACE_EXPORT RenderSettings
default_settings(const Scene& scene, SceneFormat format, const IntegratorOptions& integrator);

}  // namespace microtrace
