#pragma once
/// The rules that every scene keeps, whatever file it came from.

#include <microtrace/camera.hpp>
#include <microtrace/error.hpp>
#include <microtrace/shape.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace microtrace {

inline constexpr std::uint32_t max_image_side = 65536;  ///< pixels
inline constexpr std::uint64_t max_image_pixels = std::uint64_t{1} << 28U;

/// A number of this magnitude or above becomes infinite when it is rounded to float32.
inline constexpr double float32_bound = 0x1.ffffffp127;

/// The first rule that a part of a scene breaks.
struct BrokenRule {
  std::string field;    ///< as the struct and the JSON name it; empty if it is the whole
  std::string message;  ///< what the rule asks and what it found: "must be positive, is -1"
  ErrorKind kind = ErrorKind::invalid_scene;
};

/// All numbers finite; radius positive; normal not zero; at least one of a quadric's a to i not
/// zero; a mesh's indices below the number of its positions, its attributes as many as these.
[[nodiscard]] std::optional<BrokenRule> validate(const Shape& shape);

/// Position, direction and up finite, direction and up not zero in float32; up off the line of
/// direction by more than 1e-9 radians; vertical_fov in (0, pi); focus, height and aspect_ratio
/// positive; 0 <= near < far with near finite.
[[nodiscard]] std::optional<BrokenRule> validate(const Camera& camera);

/// At least 1 pixel each way; at most max_image_side each way and max_image_pixels together.
[[nodiscard]] std::optional<BrokenRule> validate(ImageSize size);

/// The shortest decimal number that reads back as x.
[[nodiscard]] std::string decimal(double x);
[[nodiscard]] std::string decimal(float x);

}  // namespace microtrace
