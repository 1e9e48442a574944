#include "accel/build/wide/tree_writer.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/wide/collapse.hpp"
#include "accel/build/wide/wide_tree.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

namespace microtrace::build {
namespace {

// Maximum number of references of a subtree that one thread writes.
constexpr std::uint32_t kJobSize = 1U << 13U;

// Positions in, or sizes of, the three arrays of a tree.
struct Places {
  std::size_t nodes = 0, blocks = 0, others = 0;

  Places& operator+=(const Places& b) {
    nodes += b.nodes;
    blocks += b.blocks;
    others += b.others;
    return *this;
  }
};

bool is_of_triangles(const BinaryNode& leaf) {
  return leaf.weight == leaf.count * kTriangleWeight;
}

Places leaf_size(const BinaryNode& leaf) {
  if (is_instance(leaf)) return {};
  if (is_of_triangles(leaf)) return {.blocks = blocks(leaf.weight)};
  return {.others = leaf.count};
}

Places size_as_child(const BinaryNode& node) {
  return node.plan.is_leaf() ? leaf_size(node) : Places{.nodes = 1};
}

// Returns the size of an inner node's subtree without the node itself.
Places size_below(const BinaryNode& node) {
  Places size;
  for (const BinaryNode* child : WideChildren(node)) {
    size += size_as_child(*child);
    if (!child->plan.is_leaf()) size += size_below(*child);
  }
  return size;
}

class Writer {
 public:
  Writer(const Primitives& primitives, Tree& tree) : primitives_(primitives), tree_(tree) {}

  void write(BinaryTree& planned, WorkerPool& pool) {
    ids_ = planned.ids.data();
    const BinaryNode& root = planned.root;
    Places next;
    if (root.plan.is_leaf()) {
      resize(leaf_size(root));
      tree_.root = write_leaf(root, next);
      return;
    }
    Places size = collect_jobs(root);
    pool.run(jobs_.size(), [&](std::size_t i) { jobs_[i].size = size_below(*jobs_[i].node); });
    for (const Job& job : jobs_) size += job.size;
    ++size.nodes;
    resize(size);
    next.nodes = 1;
    tree_.root = 0;
    write_node(root, 0, next);
    std::vector<std::atomic<std::uint32_t>> open(planned.subtrees.size());  // jobs of each subtree
    for (const Job& job : jobs_) ++open[subtree_of(job, planned)];
    pool.run(jobs_.size(), [&](std::size_t i) {
      const std::size_t subtree = subtree_of(jobs_[i], planned);
      Places begin = jobs_[i].begin;
      write_node(*jobs_[i].node, jobs_[i].slot, begin);
      // The blocks take several times the memory of the nodes, which is released meanwhile.
      if (--open[subtree] == 0) planned.subtrees[subtree].nodes = {};
    });
  }

 private:
  // The subtree of an inner node with at most kJobSize references whose parent has more.
  struct Job {
    const BinaryNode* node;
    Places size, begin;
    std::size_t slot = 0;
  };

  static std::size_t subtree_of(const Job& job, const BinaryTree& planned) {
    const auto after =
        std::ranges::upper_bound(planned.subtrees, job.node->begin, {}, &BinarySubtree::begin);
    return static_cast<std::size_t>(after - planned.subtrees.begin()) - 1;
  }

  static bool is_job(const BinaryNode& parent, const BinaryNode& child) {
    return parent.count > kJobSize && child.count <= kJobSize;
  }

  // Collects the jobs in the order in which write_node visits them. Returns the size of everything
  // that is in no job.
  Places collect_jobs(const BinaryNode& node) {
    if (node.count <= kJobSize) return size_below(node);
    Places size;
    for (const BinaryNode* child : WideChildren(node)) {
      size += size_as_child(*child);
      if (child->plan.is_leaf()) continue;
      if (is_job(node, *child))
        jobs_.push_back({.node = child, .size = {}, .begin = {}});
      else
        size += collect_jobs(*child);
    }
    return size;
  }

  void resize(const Places& size) {
    if (size.nodes > child_ref::kMaxNodes || size.blocks > child_ref::kMaxLeafEntries ||
        size.others > child_ref::kMaxLeafEntries)
      throw Error(ErrorKind::limit, "", "the scene has too many triangles; leave some out");
    tree_.nodes.resize(size.nodes);
    tree_.blocks.resize(size.blocks);
    tree_.others.resize(size.others);
  }

  // Writes a node to nodes[slot] and its subtree to the positions from `next` on, which is
  // advanced.
  void write_node(const BinaryNode& node, std::size_t slot, Places& next) {
    const WideChildren children(node);
    std::array<std::size_t, kWidth> slots{};
    WideNode& wide = tree_.nodes[slot];
    wide = empty_node();
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BinaryNode& child = children[i];
      set_box(wide, i, child.box);
      if (child.plan.is_leaf()) {
        wide.child[i] = write_leaf(child, next);
      } else {
        slots[i] = next.nodes++;
        wide.child[i] = static_cast<ChildRef>(slots[i]);
      }
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BinaryNode& child = children[i];
      if (child.plan.is_leaf()) continue;
      if (is_job(node, child)) {
        Job& job = jobs_[job_++];
        job.begin = next;
        job.slot = slots[i];
        next += job.size;
      } else {
        write_node(child, slots[i], next);
      }
    }
  }

  ChildRef write_leaf(const BinaryNode& leaf, Places& next) {
    const std::span<const PrimitiveId> ids(ids_ + leaf.begin, leaf.count);
    if (is_instance(leaf)) return child_ref::kFirstInstance + ids[0];
    if (!is_of_triangles(leaf)) {
      std::copy(ids.begin(), ids.end(),
                tree_.others.begin() + static_cast<std::ptrdiff_t>(next.others));
      return child_ref::kOthers | reference(next.others, leaf.count);
    }
    const std::uint32_t count = blocks(leaf.weight);
    for (std::size_t i = 0; i < count; ++i) {
      TriangleBlock& block = tree_.blocks[next.blocks + i];
      block = empty_block();
      const auto rest = ids.subspan(i * kWidth);
      for (std::size_t k = 0; k < std::min<std::size_t>(kWidth, rest.size()); ++k)
        put(block, k, rest[k]);
    }
    return child_ref::kTriangles | reference(next.blocks, count);
  }

  static ChildRef reference(std::size_t& next, std::uint32_t count) {
    const auto first = static_cast<ChildRef>(next);
    next += count;
    return first << 3U | (count - 1);
  }

  void put(TriangleBlock& block, std::size_t slot, PrimitiveId id) {
    primitives_.visit(id, [&](const auto& shape) {
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(shape)>, Triangle>)
        build::put(block, slot, id, shape);
    });
  }

  const Primitives& primitives_;
  Tree& tree_;
  const PrimitiveId* ids_ = nullptr;
  std::vector<Job> jobs_;
  std::size_t job_ = 0;  // the next job that write_node will visit
};

}  // namespace

void write_tree(BinaryTree& planned, const Primitives& primitives, WorkerPool& pool, Tree& tree) {
  Writer(primitives, tree).write(planned, pool);
}

}  // namespace microtrace::build
