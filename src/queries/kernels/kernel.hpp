#pragma once
/// Tests of the boxes of a node and of the triangles of a block, eight at a time in float64.
/// Queries that need more of a tree than the nearest hit of a ray use them. This header may contain
/// only plain data, because kernels for several instruction sets include it.

#include "accel/layout.hpp"

namespace microtrace {

struct LineInterval {
  double o[3], d[3], t_min, t_max;  ///< origin, direction and interval of a valid ray
};

/// Functions that test eight boxes or triangles. Results of type unsigned have one bit for each of
/// the eight.
struct QueryKernels {
  /// Returns the children whose boxes contain a point of the ray in its interval, and perhaps
  /// others.
  unsigned (*entered)(const WideNode& node, const LineInterval& ray);
  /// Returns the triangles that the ray's line does not certainly miss.
  unsigned (*passed)(const TriangleBlock& block, const LineInterval& ray);
  /// Computes the squared distances of the children's boxes from p; infinity for unused slots.
  /// Relative errors are less than eight times the unit roundoff.
  void (*box_distances)(const WideNode& node, const double* p, double* squared);
  /// Computes lower bounds of the squared distances of triangles from p, also with relative errors
  /// of less than eight times the unit roundoff. Unused lanes may have any result.
  void (*triangle_distances)(const TriangleBlock& block, const double* p, double* squared);
};

extern const QueryKernels kPortableQueries;
#if defined(__x86_64__)
extern const QueryKernels kAvx2Queries, kAvx512Queries;
#endif

}  // namespace microtrace
