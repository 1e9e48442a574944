#include "accel/spawn/kernels/find_departures.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kAvx512Spawn{find_departures<8>, find_origins<8>};
}
