#include "accel/spawn/kernels/find_hit_points.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kAvx512Spawn{find_hit_points<8>, find_origins<8>};
}
