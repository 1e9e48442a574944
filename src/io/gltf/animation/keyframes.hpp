#pragma once
/// What an animation's samplers say between their keys.

#include <cstddef>
#include <memory>
#include <vector>

#include <glm/vec4.hpp>

namespace microtrace::io::gltf {

using Quaternion = glm::dvec4;  ///< (x, y, z, w), as glTF orders them

enum class Interpolation { step, linear, cubic_spline };

/// One sampler: a value at each of some times.
struct Keyframes {
  Interpolation interpolation = Interpolation::linear;
  bool are_rotations = false;  ///< the values are quaternions
  std::size_t width = 1;       ///< numbers in a value
  /// Seconds, strictly ascending, at least one once keep_ascending has been through them.
  std::shared_ptr<const std::vector<float>> times;
  /// One value for each time; for cubic splines three: in-tangent, value, out-tangent.
  std::shared_ptr<const std::vector<float>> values;
};

/// Whether they are finite, and each is greater than the one before it.
[[nodiscard]] bool is_ascending(const std::vector<float>& times);
[[nodiscard]] bool are_finite(const std::vector<float>& numbers);

/// Leaves out keys that do not come after the one before them, and those with numbers that are not
/// finite; there may be none left.
void keep_ascending(Keyframes& keys);

/// The value at a time in seconds, clamped to the first and last key (glTF 2.0, section 3.11 and
/// appendix C). Rotations have unit length, but where the file's are zero.
[[nodiscard]] std::vector<double> value_at(const Keyframes& keys, double time);

/// From a (t = 0) to b (t = 1) along the shorter arc at constant speed; both of unit length, and so
/// is the result. The same bits everywhere.
[[nodiscard]] Quaternion slerp(const Quaternion& a, const Quaternion& b, double t);

/// Of unit length; zero stays zero.
[[nodiscard]] Quaternion normalised(const Quaternion& q);

}  // namespace microtrace::io::gltf
