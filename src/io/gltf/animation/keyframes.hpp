#pragma once
/// Interpolation of keyframes.

#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

using Quaternion = glm::dvec4;  ///< (x, y, z, w), the order of glTF

enum class Interpolation { step, linear, cubic_spline };

/// The keys of one animation sampler.
struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool are_rotations = false;  ///< the values are quaternions
  std::size_t width = 1;       ///< numbers in a value
  /// Seconds. keep_ascending makes them strictly ascending and leaves at least one.
  std::shared_ptr<const std::vector<float>> times;
  /// One value per time; for cubic splines three: in-tangent, value, out-tangent.
  std::shared_ptr<const std::vector<float>> values;
};

/// True if all times are finite and strictly ascending.
[[nodiscard]] bool is_ascending(const std::vector<float>& times);
[[nodiscard]] bool are_finite(const std::vector<float>& numbers);

/// Removes keys with a time that is not greater than the previous one, or with numbers that are not
/// finite. Possibly none remain.
void keep_ascending(Keyframes& keys);

/// The value at a time in seconds, clamped to the first and last key (glTF 2.0, section 3.11 and
/// appendix C). Rotations have unit length unless the stored ones are zero.
[[nodiscard]] std::vector<double> value_at(const Keyframes& keys, double time);

/// Spherical linear interpolation from a (t = 0) to b (t = 1) along the shorter arc, of unit
/// quaternions. Gives the same bits on every platform.
[[nodiscard]] Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

/// Of unit length, or zero if q is zero.
[[nodiscard]] Quaternion unit_quaternion(const Quaternion& q);

}  // namespace microtrace::io::gltf
