#include "accel/spawn/kernels/find_hit_points.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kPortableSpawn{find_hit_points<2>, find_origins<2>};
}
