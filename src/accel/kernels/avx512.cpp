#include "accel/kernels/tile.hpp"

namespace microtrace {
const Kernels kAvx512Kernels{"avx512", closest<8>, any<8>, closest_of_tile<16>};
}
