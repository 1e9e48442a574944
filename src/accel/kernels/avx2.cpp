#include "accel/kernels/tile.hpp"

namespace microtrace {
const Kernels kAvx2Kernels{"avx2", closest<8>, any<8>, closest_of_tile<8>};
}
