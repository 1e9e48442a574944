#include "render/kernels/find_normals.hpp"
#include "render/kernels/find_points.hpp"
#include "render/kernels/scatter.hpp"
#include "render/kernels/sobol_lanes.hpp"

namespace microtrace {
const ShadingKernels kAvx512Shading{"avx512", random_pairs<16>, find_points<16>, find_normals<16>,
                                    scatter<16>};
}
