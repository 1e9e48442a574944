#include "accel/kernels/round_t.hpp"
#include "accel/kernels/stream.hpp"
#include "accel/kernels/tile.hpp"

namespace microtrace {
const Kernels kAvx512Kernels{"avx512",
                             closest<8>,
                             any<8>,
                             prepare_tile<16>,
                             closest_of_tile<16>,
                             prepare_stream<16>,
                             closest_of_stream<8>,
                             any_of_stream<8, 16>,
                             round_t<8>};
}
