#pragma once
/// Answers queries for arrays of rays.

#include "accel/kernels/few_triangles.hpp"
#include "accel/kernels/occlusion_packet.hpp"
#include "accel/kernels/stream.hpp"

namespace microtrace {
namespace {

/// M: number of rays that are tested against one triangle at a time. Large triangles come first.
template <int N, int M>
void closest_of_stream(const TreeView& tree, KernelStream& stream, const StreamFallback& slow) {
  StreamItems entering;
  const StreamItems* items = nullptr;
  if (has_few_triangles<M>(tree)) {
    FewTrianglesWalk<M, false>(tree, stream, slow).run();
    if (tree.few_are_all) return;
    list_entering<M>(tree, stream, entering);
    items = &entering;
  }
  if (tree.instances != nullptr)
    StreamWalk<N, false, true>(tree, stream, slow, items).run();
  else
    StreamWalk<N, false, false>(tree, stream, slow, items).run();
}

/// M is the number of rays that packets test at a time.
template <int N, int M>
void any_of_stream(const TreeView& tree, KernelStream& stream, const StreamFallback& slow) {
  if (has_few_triangles<M>(tree)) {
    FewTrianglesWalk<M, true>(tree, stream, slow).run();
    if (tree.few_are_all) return;
  }
  StreamItems items;
  OcclusionPacketWalk<M> packets(tree, stream, slow, items);
  for (int first = 0; first < stream.count; first += OcclusionPacketWalk<M>::kRays)
    packets.run(first);
  if (tree.instances != nullptr)
    StreamWalk<N, true, true>(tree, stream, slow, &items).run();
  else
    StreamWalk<N, true, false>(tree, stream, slow, &items).run();
}

}  // namespace
}  // namespace microtrace
