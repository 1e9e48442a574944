#pragma once
/// Limits the memory of loading and rendering.

#include <microtrace/export.hpp>

#include <cstdint>
#include <mutex>
#include <string_view>

namespace microtrace {

/// Counts memory against a limit before it is allocated: nearly all memory that grows with the
/// input. May be used by any number of threads.
class MICROTRACE_EXPORT MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : limit_(limit) {}

  /// Throws Error (limit), without counting, if the limit would be exceeded. `what` names the
  /// purpose in the message: "the vertices of meshes".
  void take(std::uint64_t bytes, std::string_view what);
  void give_back(std::uint64_t bytes);

  [[nodiscard]] std::uint64_t limit() const { return limit_; }
  [[nodiscard]] std::uint64_t peak() const;  ///< maximum counted at any time

 private:
  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0, peak_ = 0;
};

/// Three quarters of the free memory: of the memory that the system reports as available, and of
/// the remaining limits of this process' control groups.
[[nodiscard]] MICROTRACE_EXPORT std::uint64_t default_memory_limit();

}  // namespace microtrace
