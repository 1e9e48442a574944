#include "accel/kernels/near/touching.hpp"
#include "accel/kernels/packet/packet.hpp"
#include "accel/kernels/packet/packet_rays.hpp"
#include "accel/kernels/packet/packet_rounding.hpp"
#include "accel/kernels/packet/packet_shapes.hpp"
#include "accel/kernels/round_t.hpp"
#include "accel/kernels/stream_queries.hpp"
#include "accel/kernels/stream_rays.hpp"

namespace microtrace {
const Kernels kPortableKernels{"portable",
                               kShapeKernels<2>,
                               closest<4>,
                               any<4>,
                               fill_packet<4>,
                               closest_of_packet<4>,
                               read_stream<4>,
                               prepare_stream<4>,
                               closest_of_stream<4, 4>,
                               any_of_stream<4, 4>,
                               round_t<4>,
                               round_t_of_packet<4>,
                               touching<4, 4>,
                               edge_tests};
}
