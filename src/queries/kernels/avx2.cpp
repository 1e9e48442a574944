#include "queries/kernels/tests_of_eight.hpp"

namespace microtrace {
const QueryKernels kAvx2Queries{entered<4>, passed<4>, box_distances<4>, triangle_distances<4>};
}
