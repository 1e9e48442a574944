#include "queries/kernels/tests_of_eight.hpp"

namespace microtrace {
const QueryKernels kAvx512Queries{entered<8>, passed<8>, box_distances<8>, triangle_distances<8>};
}
