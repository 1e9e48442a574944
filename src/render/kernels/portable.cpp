#include "render/kernels/find_normals.hpp"
#include "render/kernels/find_points.hpp"
#include "render/kernels/scatter.hpp"
#include "render/kernels/sobol_lanes.hpp"

namespace microtrace {
const ShadingKernels kPortableShading{"portable", random_pairs<4>, find_points<4>, find_normals<4>,
                                      scatter<4>};
}
