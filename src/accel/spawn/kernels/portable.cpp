#include "accel/spawn/kernels/find_departures.hpp"
#include "accel/spawn/kernels/find_origins.hpp"

namespace microtrace {
const SpawnKernels kPortableSpawn{find_departures<2>, find_origins<2>};
}
