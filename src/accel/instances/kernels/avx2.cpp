#include "accel/instances/kernels/to_scene.hpp"

namespace microtrace {
const InstanceKernels kAvx2Instances{scene_block<4>, scene_node<4>};
}
