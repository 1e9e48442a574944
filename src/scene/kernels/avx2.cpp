#include "scene/kernels/find_surfaces.hpp"
#include "scene/kernels/perspective.hpp"

namespace microtrace {
const SceneKernels kAvx2Scene{"avx2", find_surfaces<kDoubleLanes<8>>,
                              perspective_rays<kDoubleLanes<8>>, row_spreads<kDoubleLanes<8>>};
}
