#pragma once
/// Shapes relative to the origin o of rays: the terms of the filters that do not depend on a ray's
/// direction. This header may contain only plain data, because kernels for several instruction sets
/// include it.

#include <microtrace/math.hpp>

namespace microtrace {

/// A rounded number and an upper bound of its error.
struct Bounded {
  double value, error;
};

struct SeenPlane {
  DVec3 normal;
  Bounded height;  ///< normal.(point - o)
};

struct SeenDisc {
  SeenPlane plane;
  DVec3 from_center;  ///< o - center
  double radius2;     ///< the squared radius, which is exact: a product of two float32 numbers
};

struct SeenSphere {
  DVec3 m;          ///< o - center
  double radius2;   ///< exact, as above
  Bounded outside;  ///< m.m - radius2, positive if o is outside the sphere
};

struct SeenQuadric {
  DVec3 squares;  ///< (a, b, c)
  DVec3 mixed;    ///< (f, e, d): mixed[k] is the coefficient of the product of the two coordinates
                  ///< other than k
  DVec3 squares_size, mixed_size;      ///< their magnitudes
  DVec3 gradient, gradient_permanent;  ///< at o
  Bounded value;                       ///< Q(o)
};

}  // namespace microtrace
