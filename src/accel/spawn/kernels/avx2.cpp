#include "accel/spawn/kernels/find_hit_points.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kAvx2Spawn{find_hit_points<4>, find_origins<4>};
}
