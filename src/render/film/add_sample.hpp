#pragma once
#include <microtrace/math.hpp>
#include <microtrace/sample_sums.hpp>

namespace microtrace {

/// PixelSum::add() in a FloatEnvironment that the caller has set.
bool add_sample(PixelSum& sum, const Vec3& sample, float sample_alpha, const Vec3& background);

}  // namespace microtrace
