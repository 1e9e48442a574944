#pragma once
/// Accounts for the memory that the owners of data take from a MemoryBudget.

#include <microtrace/memory.hpp>

#include <cstdint>
#include <string_view>
#include <utility>

namespace microtrace {

/// The memory of one owner, which is given back to the budget when the account is destroyed.
class MemoryAccount {
 public:
  /// The budget must outlive the account. If the budget is null, nothing is counted.
  explicit MemoryAccount(MemoryBudget* budget) : budget_(budget) {}
  ~MemoryAccount() { clear(); }
  MemoryAccount(const MemoryAccount&) = delete;
  MemoryAccount& operator=(const MemoryAccount&) = delete;
  MemoryAccount(MemoryAccount&& other) noexcept
      : budget_(other.budget_), taken_(std::exchange(other.taken_, 0)) {}
  MemoryAccount& operator=(MemoryAccount&&) = delete;

  /// Charges memory to this account, see MemoryBudget::take.
  void take(std::uint64_t bytes, std::string_view what);
  /// Gives a part of the taken memory back to the budget.
  void give_back(std::uint64_t bytes);
  /// Gives all memory of this account back to the budget.
  void clear();

  [[nodiscard]] MemoryBudget* budget() const { return budget_; }

 private:
  MemoryBudget* budget_;
  std::uint64_t taken_ = 0;
};

/// During its lifetime, take_memory() on this thread charges the given account.
class MemoryScope {
 public:
  explicit MemoryScope(MemoryAccount& account);
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  MemoryAccount* former_;
};

/// Returns the account of the thread's innermost MemoryScope, or an account that counts nothing.
[[nodiscard]] MemoryAccount& memory_account();

/// Charges memory to memory_account(). Must be called before a potentially large allocation.
inline void take_memory(std::uint64_t bytes, std::string_view what) {
  memory_account().take(bytes, what);
}

/// Charges memory that is given back when the returned object is destroyed, for temporary data.
[[nodiscard]] inline MemoryAccount temporary_memory(std::uint64_t bytes, std::string_view what) {
  MemoryAccount account(memory_account().budget());
  account.take(bytes, what);
  return account;
}

}  // namespace microtrace
