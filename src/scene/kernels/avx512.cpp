#include "scene/kernels/find_surfaces.hpp"
#include "scene/kernels/perspective.hpp"

namespace microtrace {
const SceneKernels kAvx512Scene{"avx512", find_surfaces<kDoubleLanes<16>>,
                                perspective_rays<kDoubleLanes<16>>, row_spreads<kDoubleLanes<16>>};
}
