#include "accel/kernels/tile.hpp"

namespace microtrace {
const Kernels kPortableKernels{"portable", closest<4>, any<4>, closest_of_tile<4>};
}
