#include "accel/spawn/kernels/find_departures.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kAvx2Spawn{find_departures<4>, find_origins<4>};
}
