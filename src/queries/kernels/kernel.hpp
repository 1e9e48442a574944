#pragma once
/// Tests of the boxes of a node and of the triangles of a block, eight at a time in float64, for
/// queries that visit more of a tree than the nearest hit of a ray needs. Plain data only; see
/// simd/vectors.hpp for the reason.

#include "accel/layout.hpp"

namespace microtrace {

struct LineInterval {
  double o[3], d[3], t_min, t_max;  ///< numbers of a valid ray
};

/// A set of lanes has one bit for each of the eight.
struct QueryKernels {
  /// The children whose boxes contain a point of the ray in its interval, and perhaps others.
  unsigned (*entered)(const WideNode& node, const LineInterval& ray);
  /// The triangles that the ray's line does not certainly miss.
  unsigned (*passed)(const TriangleBlock& block, const LineInterval& ray);
  /// The squared distances of the children's boxes from p; infinity for unused slots. Roundings
  /// change them by less than eight units.
  void (*box_distances)(const WideNode& node, const double* p, double* squared);
  /// Lower bounds of the squared distances of triangles from p, also up to eight units. Unused
  /// lanes may have any result.
  void (*triangle_distances)(const TriangleBlock& block, const double* p, double* squared);
};

extern const QueryKernels kPortableQueries;
#if defined(__x86_64__)
extern const QueryKernels kAvx2Queries, kAvx512Queries;
#endif

}  // namespace microtrace
