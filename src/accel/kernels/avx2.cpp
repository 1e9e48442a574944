#include "accel/kernels/near/touching.hpp"
#include "accel/kernels/packet/packet.hpp"
#include "accel/kernels/packet/packet_rays.hpp"
#include "accel/kernels/packet/packet_rounding.hpp"
#include "accel/kernels/packet/packet_shapes.hpp"
#include "accel/kernels/round_t.hpp"
#include "accel/kernels/stream_queries.hpp"
#include "accel/kernels/stream_rays.hpp"

namespace microtrace {
const Kernels kAvx2Kernels{"avx2",
                           kShapeKernels<4>,
                           closest<8>,
                           any<8>,
                           fill_packet<8>,
                           closest_of_packet<8>,
                           read_stream<8>,
                           prepare_stream<8>,
                           closest_of_stream<8, 8>,
                           any_of_stream<8, 8>,
                           round_t<4>,
                           round_t_of_packet<4>,
                           touching<8, 8>,
                           edge_tests};
}
