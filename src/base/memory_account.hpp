#pragma once
/// Accounting of a MemoryBudget by owner.

#include <microtrace/memory.hpp>

#include <cstdint>
#include <string_view>
#include <utility>

namespace microtrace {

/// The memory of one owner, released with it.
class MemoryAccount {
 public:
  /// The budget must outlive the account. With null nothing is counted.
  explicit MemoryAccount(MemoryBudget* budget) : budget_(budget) {}
  ~MemoryAccount() { clear(); }
  MemoryAccount(const MemoryAccount&) = delete;
  MemoryAccount& operator=(const MemoryAccount&) = delete;
  MemoryAccount(MemoryAccount&& other) noexcept
      : budget_(other.budget_), taken_(std::exchange(other.taken_, 0)) {}
  MemoryAccount& operator=(MemoryAccount&&) = delete;

  /// As MemoryBudget::take.
  void take(std::uint64_t bytes, std::string_view what);
  /// Releases all memory.
  void clear();

  [[nodiscard]] MemoryBudget* budget() const { return budget_; }

 private:
  MemoryBudget* budget_;
  std::uint64_t taken_ = 0;
};

/// During its lifetime, memory taken by this thread is charged to the account.
class MemoryScope {
 public:
  explicit MemoryScope(MemoryAccount& account);
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  MemoryAccount* former_;
};

/// The account of the thread's innermost scope, or an account that counts nothing.
[[nodiscard]] MemoryAccount& memory_account();

/// Must be called before a potentially large allocation.
inline void take_memory(std::uint64_t bytes, std::string_view what) {
  memory_account().take(bytes, what);
}

/// Charges memory that is released earlier than the account: with the returned object.
[[nodiscard]] inline MemoryAccount temporary_memory(std::uint64_t bytes, std::string_view what) {
  MemoryAccount account(memory_account().budget());
  account.take(bytes, what);
  return account;
}

}  // namespace microtrace
