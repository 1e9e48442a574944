#include <microtrace/placement.hpp>

#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

namespace microtrace {
namespace {

/// Returns v scaled to unit length, or zero if v is zero or not finite.
DVec3 direction_of(const DVec3& v) {
  const double greatest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(greatest > 0) || !std::isfinite(greatest)) return DVec3(0);
  const DVec3 scaled = v / greatest;  // prevents overflow and underflow of the squares
  return scaled / std::sqrt(glm::dot(scaled, scaled));
}

DVec3 product(const DVec3 (&columns)[3], const DVec3& v) {
  return columns[0] * v.x + columns[1] * v.y + columns[2] * v.z;
}

}  // namespace

Placement::Placement(const DMat4& m)
    : columns_{DVec3(m[0]), DVec3(m[1]), DVec3(m[2]), DVec3(m[3])} {}

bool Placement::is_mirrored() const {
  if (!(glm::determinant(glm::dmat3(columns_[0], columns_[1], columns_[2])) < 0)) return false;
  // Below rotated nodes, a scale of 0 gives a determinant of either sign, by rounding.
  constexpr double kFlat = 1e-12;
  return glm::determinant(glm::dmat3(direction_of(columns_[0]), direction_of(columns_[1]),
                                     direction_of(columns_[2]))) < -kFlat;
}

DVec3 Placement::normal(const DVec3& n) const {
  // The matrix of cofactors is the inverse transpose times the determinant. It exists even for
  // singular matrices.
  const double sign = is_mirrored() ? -1 : 1;
  DVec3 cofactors[3];
  for (int k = 0; k < 3; ++k)
    cofactors[k] = sign * glm::cross(columns_[(k + 1) % 3], columns_[(k + 2) % 3]);
  return direction_of(product(cofactors, n));
}

DVec3 Placement::direction(const DVec3& v) const {
  const DVec3 linear[3] = {columns_[0], columns_[1], columns_[2]};
  return direction_of(product(linear, v));
}

}  // namespace microtrace
