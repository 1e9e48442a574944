#include "accel/build/wide/tree_writer.hpp"

#include "accel/build/binary/binning.hpp"
#include "accel/build/references/shape_reader.hpp"
#include "accel/build/wide/collapse.hpp"
#include "accel/build/wide/wide_tree.hpp"
#include "base/release.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>
#include <span>

namespace microtrace::build {
namespace {

// Maximum number of references of a subtree that one thread writes.
constexpr std::uint32_t kJobSize = 1U << 13U;

// Positions in, or sizes of, the arrays of a tree.
struct Places {
  std::size_t nodes = 0, blocks = 0, others = 0, instances = 0;

  Places& operator+=(const Places& b) {
    nodes += b.nodes;
    blocks += b.blocks;
    others += b.others;
    instances += b.instances;
    return *this;
  }
};

// The blocks of several leaves, and the number of blocks of each.
struct Filled {
  PageVector<TriangleBlock> blocks;
  std::vector<std::uint8_t> counts;
};

// Where write_node continues in the arrays of a tree.
struct Cursor {
  Places next;
  const std::uint8_t* counts = nullptr;  // of the blocks of the next leaves, if they are filled
};

class Writer {
 public:
  Writer(const Primitives& primitives, const Instances& instances, Tree& tree)
      : primitives_(primitives), instances_(instances), tree_(tree) {}

  void write(BinaryTree& planned, WorkerPool& pool) {
    ids_ = planned.ids;
    triangle_weight_ = planned.triangle_weight;
    const BinaryNode& root = planned.root;
    Cursor cursor;
    if (root.plan().is_leaf()) {
      reserve(leaf_size(root));
      tree_.root = write_leaf(root, cursor);
      return;
    }
    Places size = collect_jobs(root);
    job_nodes_ = ++size.nodes;
    pool.run(jobs_.size(), [&](std::size_t i) { jobs_[i].size = size_below(*jobs_[i].node); });
    for (const Job& job : jobs_) size += job.size;
    reserve(size);
    cursor.next.nodes = 1;
    tree_.root = 0;
    write_node(root, 0, cursor);
    write_jobs(planned, pool);
  }

 private:
  // The subtree of an inner node with at most kJobSize references whose parent has more.
  struct Job {
    const BinaryNode* node;
    Places size, begin;
    std::size_t slot = 0;
  };

  // Writes all jobs, several at a time. The blocks of a job come after those of the jobs before it,
  // and their number is known only after they are filled.
  void write_jobs(BinaryTree& planned, WorkerPool& pool) {
    std::vector<std::atomic<std::uint32_t>> open(planned.subtrees.size());  // jobs of each subtree
    for (const Job& job : jobs_) ++open[subtree_of(job, planned)];
    Release<PrimitiveId> release(planned.ids);
    std::vector<Filled> filled(std::min(jobs_.size(), 2 * pool.size()));
    for (std::size_t first = 0; first < jobs_.size(); first += filled.size()) {
      const std::span<Job> jobs =
          std::span(jobs_).subspan(first, std::min(filled.size(), jobs_.size() - first));
      pool.run(jobs.size(), [&](std::size_t i) { fill(*jobs[i].node, filled[i]); });
      for (std::size_t i = 0; i < jobs.size(); ++i) {
        jobs[i].begin.blocks = tree_.blocks.size();
        add_blocks(filled[i].blocks.size());
      }
      pool.run(jobs.size(), [&](std::size_t i) {
        const Job& job = jobs[i];
        std::ranges::copy(filled[i].blocks, tree_.blocks.data() + job.begin.blocks);
        Cursor cursor{.next = job.begin, .counts = filled[i].counts.data()};
        write_node(*job.node, job.slot, cursor);
        // The blocks take the memory of the ids and the nodes, which is released meanwhile.
        release(job.node->begin(), job.node->count());
        const std::size_t subtree = subtree_of(job, planned);
        if (--open[subtree] == 0) planned.subtrees[subtree].nodes = {};
      });
    }
  }

  // Returns the size of a leaf, with an upper bound of the number of blocks.
  [[nodiscard]] Places leaf_size(const BinaryNode& leaf) const {
    if (is_instance(leaf)) return {.instances = 1};
    if (!has_triangles(leaf, triangle_weight_)) return {.others = leaf.count()};
    return {.blocks = (leaf.count() + TriangleBlock::kUnshared - 1) / TriangleBlock::kUnshared};
  }

  [[nodiscard]] Places size_as_child(const BinaryNode& node) const {
    return node.plan().is_leaf() ? leaf_size(node) : Places{.nodes = 1};
  }

  // Returns the size of an inner node's subtree without the node itself.
  [[nodiscard]] Places size_below(const BinaryNode& node) const {
    Places size;
    for (const BinaryNode* child : WideChildren(node)) {
      size += size_as_child(*child);
      if (!child->plan().is_leaf()) size += size_below(*child);
    }
    return size;
  }

  static std::size_t subtree_of(const Job& job, const BinaryTree& planned) {
    const auto after =
        std::ranges::upper_bound(planned.subtrees, job.node->begin(), {}, &BinarySubtree::begin);
    return static_cast<std::size_t>(after - planned.subtrees.begin()) - 1;
  }

  static bool is_job(const BinaryNode& parent, const BinaryNode& child) {
    return parent.count() > kJobSize && child.count() <= kJobSize;
  }

  // Collects the jobs in the order in which write_node visits them. Returns the size of everything
  // that is in no job.
  Places collect_jobs(const BinaryNode& node) {
    if (node.count() <= kJobSize) return size_below(node);
    Places size;
    for (const BinaryNode* child : WideChildren(node)) {
      size += size_as_child(*child);
      if (child->plan().is_leaf()) continue;
      if (is_job(node, *child))
        jobs_.push_back({.node = child, .size = {}, .begin = {}});
      else
        size += collect_jobs(*child);
    }
    return size;
  }

  void reserve(const Places& size) {
    check(size.nodes <= child_ref::kMaxNodes && size.others <= child_ref::kMaxLeafEntries);
    tree_.nodes.resize(size.nodes);
    tree_.others.resize(size.others);
    tree_.instances.resize(size.instances);
    tree_.blocks.reserve(size.blocks);  // pages that no blocks are written to take no memory
  }

  void add_blocks(std::size_t count) {
    tree_.blocks.resize(tree_.blocks.size() + count);
    check(tree_.blocks.size() <= child_ref::kMaxLeafEntries);
  }

  static void check(bool fits) {
    if (!fits)
      throw Error(ErrorKind::limit, "", "the scene has too many triangles; leave some out");
  }

  // Writes a node to nodes[slot] and its subtree to the positions from the cursor on, which is
  // advanced.
  void write_node(const BinaryNode& node, std::size_t slot, Cursor& cursor) {
    const WideChildren children(node);
    std::array<std::size_t, kWidth> slots{};
    WideNode& wide = tree_.nodes[slot];
    wide = empty_node();
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BinaryNode& child = children[i];
      set_box(wide, i, child.box());
      if (child.plan().is_leaf()) {
        wide.child[i] = write_leaf(child, cursor);
      } else {
        slots[i] = cursor.next.nodes++;
        wide.child[i] = static_cast<ChildRef>(slots[i]);
      }
    }
    for (std::size_t i = 0; i < children.size(); ++i) {
      const BinaryNode& child = children[i];
      if (child.plan().is_leaf()) continue;
      if (is_job(node, child)) {
        Job& job = jobs_[job_++];
        job.begin = cursor.next;
        job.begin.nodes = job_nodes_;
        job.slot = slots[i];
        job_nodes_ += job.size.nodes;
        cursor.next.others += job.size.others;
        cursor.next.instances += job.size.instances;
      } else {
        write_node(child, slots[i], cursor);
      }
    }
  }

  ChildRef write_leaf(const BinaryNode& leaf, Cursor& cursor) {
    const std::span<const PrimitiveId> ids = ids_of(leaf);
    if (is_instance(leaf)) {
      const std::size_t instance = cursor.next.instances++;
      tree_.instances[instance] = instances_.make(ids[0], leaf.box());
      return child_ref::kFirstInstance + static_cast<ChildRef>(instance);
    }
    if (!has_triangles(leaf, triangle_weight_)) {
      std::ranges::copy(ids, tree_.others.data() + cursor.next.others);
      return child_ref::kOthers | reference(cursor.next.others, leaf.count());
    }
    if (cursor.counts != nullptr)
      return child_ref::kTriangles | reference(cursor.next.blocks, *cursor.counts++);
    cursor.next.blocks = tree_.blocks.size();
    ShapeReader shapes(primitives_);
    fill(leaf, shapes, tree_.blocks);
    check(tree_.blocks.size() <= child_ref::kMaxLeafEntries);
    return child_ref::kTriangles |
           reference(cursor.next.blocks, tree_.blocks.size() - cursor.next.blocks);
  }

  static ChildRef reference(std::size_t& next, std::size_t count) {
    const auto first = static_cast<ChildRef>(next);
    next += count;
    return first << 3U | static_cast<ChildRef>(count - 1);
  }

  // Fills the blocks of all leaves below a node, in the order in which write_node visits them.
  void fill(const BinaryNode& node, Filled& filled) const {
    filled.blocks.clear();
    filled.counts.clear();
    ShapeReader shapes(primitives_);
    for_each_leaf(node, [&](const BinaryNode& leaf) {
      if (!has_triangles(leaf, triangle_weight_)) return;
      const std::size_t before = filled.blocks.size();
      fill(leaf, shapes, filled.blocks);
      filled.counts.push_back(static_cast<std::uint8_t>(filled.blocks.size() - before));
    });
  }

  template <class F>
  static void for_each_leaf(const BinaryNode& node, const F& f) {
    const WideChildren children(node);
    for (const BinaryNode* child : children)
      if (child->plan().is_leaf()) f(*child);
    for (const BinaryNode* child : children)
      if (!child->plan().is_leaf()) for_each_leaf(*child, f);
  }

  // Appends blocks with the triangles of a leaf.
  void fill(const BinaryNode& leaf, ShapeReader& shapes, PageVector<TriangleBlock>& blocks) const {
    std::optional<BlockFiller> filler;
    const std::size_t begin = leaf.begin();
    for (std::size_t i = begin; i < begin + leaf.count(); ++i) {
      // Leaves are filled mostly in the order of their ids.
      const std::size_t ahead = i + ShapeReader::kAhead;
      if (ahead < ids_.size()) shapes.prefetch(ids_[ahead]);
      const PrimitiveId id = ids_[i];
      const Triangle triangle = *shapes.triangle(id);
      if (filler && filler->add(id, triangle)) continue;
      filler.emplace(blocks.emplace_back());
      filler->add(id, triangle);
    }
  }

  [[nodiscard]] std::span<const PrimitiveId> ids_of(const BinaryNode& leaf) const {
    return ids_.subspan(leaf.begin(), leaf.count());
  }

  const Primitives& primitives_;
  const Instances& instances_;
  Tree& tree_;
  std::span<const PrimitiveId> ids_;
  std::uint32_t triangle_weight_ = kTriangleWeight;
  std::vector<Job> jobs_;
  std::size_t job_ = 0;        // the next job that write_node will visit
  std::size_t job_nodes_ = 0;  // where its nodes begin
};

}  // namespace

void write_tree(BinaryTree& planned, const Primitives& primitives, const Instances& instances,
                WorkerPool& pool, Tree& tree) {
  Writer(primitives, instances, tree).write(planned, pool);
}

}  // namespace microtrace::build
