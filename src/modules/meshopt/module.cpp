/// Provides meshoptimizer's decoders behind the C interface of io/gltf/bytes/meshopt_abi.hpp. They
/// compute only with integers, so their versions for different processors give the same bytes. The
/// library's own filters compute with floating-point numbers and are not used.

#include "io/gltf/bytes/meshopt_abi.hpp"

#include <meshoptimizer.h>

extern "C" __attribute__((visibility("default"))) int microtrace_decode_meshopt_v2(
    const MicrotraceMeshopt* view, void* destination) {
  const auto [bytes, size, count, stride, mode] = *view;
  int result = 1;
  switch (mode) {
    case microtrace_meshopt_attributes:
      result = meshopt_decodeVertexBuffer(destination, count, stride, bytes, size);
      break;
    case microtrace_meshopt_triangles:
      result = meshopt_decodeIndexBuffer(destination, count, stride, bytes, size);
      break;
    case microtrace_meshopt_indices:
      result = meshopt_decodeIndexSequence(destination, count, stride, bytes, size);
      break;
  }
  return result == 0 ? 1 : 0;
}
