#pragma once
/// Limits the memory used for loading and rendering.

#include <microtrace/export.hpp>

#include <cstdint>
#include <mutex>
#include <string_view>

namespace microtrace {

/// Counts memory against a limit, before the memory is allocated. The library counts nearly all
/// memory whose size depends on the input. May be used by any number of threads.
class MICROTRACE_EXPORT MemoryBudget {
 public:
  explicit MemoryBudget(std::uint64_t limit) : limit_(limit) {}

  /// Counts `bytes`. If the limit would be exceeded, throws Error (limit) and counts nothing.
  /// `what` names the purpose in the message, such as "the vertices of meshes".
  void take(std::uint64_t bytes, std::string_view what);
  void give_back(std::uint64_t bytes);

  [[nodiscard]] std::uint64_t limit() const { return limit_; }
  [[nodiscard]] std::uint64_t peak() const;  ///< the maximum of the counted bytes so far

 private:
  const std::uint64_t limit_;
  mutable std::mutex mutex_;
  std::uint64_t used_ = 0, peak_ = 0;
};

/// Returns three quarters of the free memory in bytes. The free memory is what the system reports
/// as available, or the remaining limit of one of the process's control groups if that is less.
[[nodiscard]] MICROTRACE_EXPORT std::uint64_t default_memory_limit();

}  // namespace microtrace
