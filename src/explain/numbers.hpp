#pragma once
/// The numbers that decide how a ray's line meets a primitive, computed exactly and rounded once.

#include <microtrace/explain.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/ray.hpp>

#include <string>
#include <string_view>

namespace microtrace {

[[nodiscard]] IntersectionNumbers intersection_numbers(const Primitives& primitives, const Ray& ray,
                                                       PrimitiveId id);

/// Returns where the numbers of a primitive are derived.
[[nodiscard]] std::string_view derivation_of(const Primitives& primitives, PrimitiveId id);

/// Returns why a ray with these numbers, which has no hit, misses the primitive.
[[nodiscard]] std::string miss_reason(const IntersectionNumbers& numbers);

}  // namespace microtrace
