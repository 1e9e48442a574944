#include "accel/instances/kernels/to_scene.hpp"

namespace microtrace {
const InstanceKernels kPortableInstances{scene_block<2>, scene_node<2>};
}
