#pragma once
/// Interpolates keyframes.

#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

using Quaternion = glm::dvec4;  ///< (x, y, z, w), as in glTF

enum class Interpolation { step, linear, cubic_spline };

/// The keys of one animation sampler.
struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool are_rotations = false;  ///< the values are quaternions
  std::size_t width = 1;       ///< number of components of a value
  /// Times in seconds. keep_ascending makes them strictly ascending.
  std::shared_ptr<const std::vector<float>> times;
  /// One value per time. A cubic spline has three: in-tangent, value, out-tangent.
  std::shared_ptr<const std::vector<float>> values;
};

/// Returns true if all times are finite and strictly ascending.
[[nodiscard]] bool is_ascending(const std::vector<float>& times);
[[nodiscard]] bool are_finite(const std::vector<float>& numbers);

/// Removes keys whose time does not exceed that of the previous key, and keys with numbers that are
/// not finite. There may be no keys left.
void keep_ascending(Keyframes& keys);

/// Returns the value at `time` in seconds. The time is clamped to the range of the keys (glTF 2.0,
/// section 3.11 and appendix C). Rotations have unit length unless the stored ones are zero.
[[nodiscard]] std::vector<double> value_at(const Keyframes& keys, double time);

/// Interpolates between unit quaternions a (t = 0) and b (t = 1) along the shorter arc at constant
/// angular speed. Gives the same bits on every platform.
[[nodiscard]] Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

/// Returns q scaled to unit length, or zero if q is zero.
[[nodiscard]] Quaternion unit_quaternion(const Quaternion& q);

}  // namespace microtrace::io::gltf
