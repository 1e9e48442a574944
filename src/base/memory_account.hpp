#pragma once
/// Who has taken how much of a MemoryBudget.

#include <microtrace/memory.hpp>

#include <cstdint>
#include <string_view>
#include <utility>

namespace microtrace {

/// What belongs to one owner, given back with it.
class MemoryAccount {
 public:
  /// The budget must outlive the account; null: nothing is counted.
  explicit MemoryAccount(MemoryBudget* budget) : budget_(budget) {}
  ~MemoryAccount() { clear(); }
  MemoryAccount(const MemoryAccount&) = delete;
  MemoryAccount& operator=(const MemoryAccount&) = delete;
  MemoryAccount(MemoryAccount&& other) noexcept
      : budget_(other.budget_), taken_(std::exchange(other.taken_, 0)) {}
  MemoryAccount& operator=(MemoryAccount&&) = delete;

  /// As MemoryBudget::take.
  void take(std::uint64_t bytes, std::string_view what);
  /// Gives all back.
  void clear();

  [[nodiscard]] MemoryBudget* budget() const { return budget_; }

 private:
  MemoryBudget* budget_;
  std::uint64_t taken_ = 0;
};

/// While it lives, what this thread takes is the account's.
class MemoryScope {
 public:
  explicit MemoryScope(MemoryAccount& account);
  ~MemoryScope();
  MemoryScope(const MemoryScope&) = delete;
  MemoryScope& operator=(const MemoryScope&) = delete;

 private:
  MemoryAccount* former_;
};

/// That of the thread's innermost scope, or one that counts nothing.
[[nodiscard]] MemoryAccount& memory_account();

/// To be said before memory is taken that may be large.
inline void take_memory(std::uint64_t bytes, std::string_view what) {
  memory_account().take(bytes, what);
}

/// The same for memory that is given back sooner than the account: with the result.
[[nodiscard]] inline MemoryAccount temporary_memory(std::uint64_t bytes, std::string_view what) {
  MemoryAccount account(memory_account().budget());
  account.take(bytes, what);
  return account;
}

}  // namespace microtrace
