#include "scene/kernels/find_surfaces.hpp"
#include "scene/kernels/perspective.hpp"

namespace microtrace {
const SceneKernels kPortableScene{"portable", find_surfaces<kDoubleLanes<4>>,
                                  perspective_rays<kDoubleLanes<4>>, row_spreads<kDoubleLanes<4>>};
}
