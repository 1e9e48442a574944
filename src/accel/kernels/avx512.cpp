#include "accel/kernels/near/touching.hpp"
#include "accel/kernels/packet/packet.hpp"
#include "accel/kernels/packet/packet_rays.hpp"
#include "accel/kernels/packet/packet_rounding.hpp"
#include "accel/kernels/packet/packet_shapes.hpp"
#include "accel/kernels/round_t.hpp"
#include "accel/kernels/stream_queries.hpp"
#include "accel/kernels/stream_rays.hpp"

namespace microtrace {
const Kernels kAvx512Kernels{"avx512",
                             kShapeKernels<8>,
                             closest<8>,
                             any<8>,
                             fill_packet<16>,
                             closest_of_packet<16>,
                             read_stream<16>,
                             prepare_stream<16>,
                             closest_of_stream<8, 16>,
                             any_of_stream<8, 16>,
                             round_t<8>,
                             round_t_of_packet<8>,
                             touching<8, 16>,
                             edge_tests};
}
