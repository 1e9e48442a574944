#include "render/kernels/find_normals.hpp"
#include "render/kernels/find_points.hpp"
#include "render/kernels/scatter.hpp"

namespace microtrace {
const ShadingKernels kAvx512Shading{"avx512", find_points<16>, find_normals<16>, scatter<16>};
}
