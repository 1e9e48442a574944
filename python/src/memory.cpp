/// Memory for the arrays of pictures.

#include "common.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <nanobind/stl/vector.h>
#include <new>
#include <sys/mman.h>
#include <vector>

namespace microtrace::python {
namespace {

[[noreturn]] void refuse_memory() {
  throw Error(ErrorKind::limit, "",
              "no memory for the arrays of the pictures; ask for smaller or fewer ones");
}

/// A block of memory for an array. The memory of deleted arrays is kept for new arrays of the same
/// size, because getting cleared pages from the system takes as long as filling them.
class Memory {
 public:
  explicit Memory(std::size_t bytes) : bytes_(rounded(bytes)), data_(take(bytes_)) {
    if (data_ != nullptr) return;
    const bool is_large = bytes_ >= 2 * kHugePage;
    data_ = std::aligned_alloc(is_large ? kHugePage : kLine, bytes_);
    if (data_ == nullptr) refuse_memory();
    if (is_large) madvise(data_, bytes_, MADV_HUGEPAGE);
  }
  Memory(const Memory&) = delete;
  Memory& operator=(const Memory&) = delete;
  ~Memory() { keep({.data = data_, .bytes = bytes_}); }

  [[nodiscard]] void* data() const { return data_; }

 private:
  struct Block {
    void* data;
    std::size_t bytes;
  };
  /// Blocks that no array uses, oldest first.
  struct Kept {
    std::mutex mutex;
    std::vector<Block> blocks;
    std::size_t bytes = 0;
  };

  static constexpr std::size_t kLine = 64, kHugePage = std::size_t{1} << 21U;
  static constexpr std::size_t kMostKept = std::size_t{1} << 26U;

  /// Rounds a size up, because std::aligned_alloc requires a multiple of the alignment.
  static std::size_t rounded(std::size_t bytes) {
    const std::size_t unit = bytes >= 2 * kHugePage ? kHugePage : kLine;
    return std::max(unit, (bytes + unit - 1) / unit * unit);
  }

  /// The blocks are never destroyed, because arrays may outlive this module.
  static Kept& kept() {
    static auto* const result = new Kept;
    return *result;
  }

  static void* take(std::size_t bytes) {
    Kept& all = kept();
    const std::scoped_lock lock(all.mutex);
    const auto found = std::ranges::find(all.blocks, bytes, &Block::bytes);
    if (found == all.blocks.end()) return nullptr;
    void* const data = found->data;
    all.bytes -= bytes;
    all.blocks.erase(found);
    return data;
  }

  static void keep(const Block& block) noexcept {
    Kept& all = kept();
    const std::scoped_lock lock(all.mutex);
    if (block.bytes > kMostKept) return std::free(block.data);
    for (; all.bytes + block.bytes > kMostKept; all.blocks.erase(all.blocks.begin())) {
      all.bytes -= all.blocks.front().bytes;
      std::free(all.blocks.front().data);
    }
    try {
      all.blocks.push_back(block);
      all.bytes += block.bytes;
    } catch (const std::bad_alloc&) {
      std::free(block.data);
    }
  }

  std::size_t bytes_;
  void* data_;
};

/// Makes an array of uninitialized 32-bit values.
nb::object picture_array(const std::vector<std::size_t>& shape, bool is_integer) {
  std::size_t bytes = 4;
  for (const std::size_t extent : shape) {
    if (__builtin_mul_overflow(bytes, extent, &bytes) || bytes > PTRDIFF_MAX / 2) refuse_memory();
  }
  auto* const memory = new Memory(bytes);
  const nb::capsule keeper(memory, [](void* p) noexcept { delete static_cast<Memory*>(p); });
  const nb::dlpack::dtype type = is_integer ? nb::dtype<std::uint32_t>() : nb::dtype<float>();
  return nb::cast(
      nb::ndarray<nb::numpy>(memory->data(), shape.size(), shape.data(), keeper, nullptr, type));
}

}  // namespace

void bind_memory(nb::module_& module) {
  module.def("picture_array", &picture_array, WholeCall());
}

}  // namespace microtrace::python
