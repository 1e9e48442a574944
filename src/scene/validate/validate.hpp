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

/// Numbers with at least this magnitude round to infinity in float32.
inline constexpr double kFloat32Bound = 0x1.ffffffp127;

/// A rule that a part of a scene breaks. The functions below return the first broken rule.
struct BrokenRule {
  std::string field;  ///< name in the struct and in JSON; empty if the rule concerns the whole part
  std::string message;  ///< the rule and the value: "must be positive, is -1"
  ErrorKind kind = ErrorKind::invalid_scene;
};

/// Checks that all numbers are finite, radii are positive, normals are not zero, and at least one
/// of a quadric's coefficients a to i is not zero. A mesh's indices must be less than its number of
/// positions, and each attribute array must have as many elements as there are positions.
[[nodiscard]] std::optional<BrokenRule> validate(const Shape& shape);

/// Checks a mesh's indices and the sizes of its attribute arrays. Breaking these rules would cause
/// undefined behavior.
[[nodiscard]] std::optional<BrokenRule> broken_index(const Mesh& mesh);

/// Checks the placement of a placed mesh.
[[nodiscard]] std::optional<BrokenRule> broken_placement(const PlacedMesh& mesh);

/// Checks that position, direction and up are finite, and that direction and up are not zero in
/// float32. Up must be at least 1e-9 radians from parallel to direction. vertical_fov must be in
/// (0, pi); focus, height, aspect_ratio, fx and fy must be positive. A calibration's image must
/// have a valid size. Depths must satisfy 0 <= near < far with finite near.
[[nodiscard]] std::optional<BrokenRule> validate(const Camera& camera);

/// Check that all numbers are within their documented ranges.
[[nodiscard]] std::optional<BrokenRule> validate(const Material& material);
[[nodiscard]] std::optional<BrokenRule> validate(const Light& light);
[[nodiscard]] std::optional<BrokenRule> validate(const Environment& environment);

/// Checks that each side has 1 to kMaxImageSide pixels, and that the image has at most
/// kMaxImagePixels pixels.
[[nodiscard]] std::optional<BrokenRule> validate(ImageSize size);

/// The shortest decimal representation that reads back as x.
[[nodiscard]] std::string decimal(double x);
[[nodiscard]] std::string decimal(float x);

}  // namespace microtrace
