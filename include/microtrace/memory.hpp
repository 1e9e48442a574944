#pragma once
/// How much memory loading and rendering may take.

#include <microtrace/export.hpp>

#include <cstdint>
#include <mutex>
#include <string_view>

namespace microtrace {

/// Counts memory against a limit before it is taken: all that grows with the input, which is nearly
/// all. Any number of threads may use one at a time.
class MICROTRACE_EXPORT MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : limit_(limit) {}

  /// Throws Error (limit) where the limit would be exceeded, and counts nothing then. `what` it is
  /// for stands in the message: "the vertices of meshes".
  void take(std::uint64_t bytes, std::string_view what);
  void give_back(std::uint64_t bytes);

  [[nodiscard]] std::uint64_t limit() const { return limit_; }
  [[nodiscard]] std::uint64_t peak() const;  ///< the most that was counted at a time

 private:
  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0, peak_ = 0;
};

/// Three quarters of what is free now: of the memory that the system says is available, and of what
/// the control groups of this process have left.
[[nodiscard]] MICROTRACE_EXPORT std::uint64_t default_memory_limit();

}  // namespace microtrace
