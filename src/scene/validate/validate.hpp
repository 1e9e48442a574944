#pragma once
/// The rules for scenes of all file formats.

#include <microtrace/camera.hpp>
#include <microtrace/environment.hpp>
#include <microtrace/error.hpp>
#include <microtrace/light.hpp>
#include <microtrace/material.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace microtrace {

inline constexpr std::uint32_t kMaxImageSide = 65536;  ///< pixels
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28U;

/// Numbers of at least this magnitude round to infinity in float32.
inline constexpr double kFloat32Bound = 0x1.ffffffp127;

/// The first broken rule of a part of a scene.
struct BrokenRule {
  std::string field;    ///< name in the struct and in JSON; empty if the whole part is meant
  std::string message;  ///< the rule and the value: "must be positive, is -1"
  ErrorKind kind = ErrorKind::invalid_scene;
};

/// All numbers finite; radius positive; normal not zero; at least one of a quadric's a to i not
/// zero; a mesh's indices below the number of its positions, and its attributes of the same number.
[[nodiscard]] std::optional<BrokenRule> validate(const Shape& shape);

/// The rules of meshes about indices and the number of attributes, which keep a program from
/// undefined behavior.
[[nodiscard]] std::optional<BrokenRule> broken_index(const Mesh& mesh);

/// Position, direction and up finite, direction and up not zero in float32; the angle between up
/// and direction's line more than 1e-9 radians; vertical_fov in (0, pi); focus, height,
/// aspect_ratio, fx and fy positive; the image of a calibration of valid size; 0 <= near < far with
/// near finite.
[[nodiscard]] std::optional<BrokenRule> validate(const Camera& camera);

/// All numbers in the documented ranges.
[[nodiscard]] std::optional<BrokenRule> validate(const Material& material);
[[nodiscard]] std::optional<BrokenRule> validate(const Light& light);
[[nodiscard]] std::optional<BrokenRule> validate(const Environment& environment);

/// At least 1 pixel per side; at most kMaxImageSide per side and kMaxImagePixels in all.
[[nodiscard]] std::optional<BrokenRule> validate(ImageSize size);

/// The shortest decimal number that reads back as x.
[[nodiscard]] std::string decimal(double x);
[[nodiscard]] std::string decimal(float x);

}  // namespace microtrace
