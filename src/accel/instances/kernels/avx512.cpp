#include "accel/instances/kernels/to_scene.hpp"

namespace microtrace {
const InstanceKernels kAvx512Instances{scene_block<8>, scene_node<8>};
}
