#include "render/kernels/find_normals.hpp"
#include "render/kernels/find_points.hpp"
#include "render/kernels/scatter.hpp"

namespace microtrace {
const ShadingKernels kAvx2Shading{"avx2", find_points<8>, find_normals<8>, scatter<8>};
}
