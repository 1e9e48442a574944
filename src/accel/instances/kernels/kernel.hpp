#pragma once
/// Kernels that transform parts of a mesh's tree to the scene. This header may contain only plain
/// data, because kernels for several instruction sets include it.

#include "accel/layout.hpp"

namespace microtrace {

struct InstanceKernels {
  /// Transforms the triangles of a block as Placement::point does, adds Instance::first_id to their
  /// ids, and exchanges two vertices of each if the instance is mirrored.
  void (*scene_block)(const Instance& instance, const TriangleBlock& from, TriangleBlock& to);
  /// Transforms a node's boxes to boxes that contain the transformed triangles.
  void (*scene_node)(const Instance& instance, const WideNode& from, WideNode& to);
};

extern const InstanceKernels kPortableInstances;
#if defined(__x86_64__)
extern const InstanceKernels kAvx2Instances, kAvx512Instances;
#endif

}  // namespace microtrace
