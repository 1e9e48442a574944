#include "base/memory_account.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>

namespace microtrace {
namespace {

thread_local MemoryAccount* current = nullptr;

/// Formats a size, for example as "1.5 GiB".
std::string readable(std::uint64_t bytes) {
  constexpr std::array<const char*, 4> kUnits = {"KiB", "MiB", "GiB", "TiB"};
  double number = static_cast<double>(bytes) / 1024;
  std::size_t unit = 0;
  for (; number >= 1024 && unit + 1 < kUnits.size(); ++unit) number /= 1024;
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.1f ", number);
  return std::string(text.data()) + kUnits[unit];
}

}  // namespace

void MemoryBudget::take(std::uint64_t bytes, std::string_view what) {
  const std::scoped_lock lock(mutex_);
  if (bytes > limit_ - used_) {
    std::string message(what);
    message += ": " + readable(bytes) + " are needed in addition to the " + readable(used_) +
               " in use, but the memory limit is " + readable(limit_) +
               "; raise it (--memory-limit) if the machine has enough memory, or reduce the "
               "picture or scene";
    throw Error(ErrorKind::limit, "", message);
  }
  used_ += bytes;
  peak_ = std::max(peak_, used_);
}

void MemoryBudget::give_back(std::uint64_t bytes) {
  const std::scoped_lock lock(mutex_);
  used_ -= bytes;
}

std::uint64_t MemoryBudget::peak() const {
  const std::scoped_lock lock(mutex_);
  return peak_;
}

void MemoryAccount::take(std::uint64_t bytes, std::string_view what) {
  if (budget_ == nullptr) return;
  budget_->take(bytes, what);
  taken_ += bytes;
}

void MemoryAccount::give_back(std::uint64_t bytes) {
  if (budget_ == nullptr) return;
  budget_->give_back(bytes);
  taken_ -= bytes;
}

void MemoryAccount::clear() {
  give_back(taken_);
}

MemoryScope::MemoryScope(MemoryAccount& account) : former_(std::exchange(current, &account)) {}

MemoryScope::~MemoryScope() {
  current = former_;
}

MemoryAccount& memory_account() {
  static thread_local MemoryAccount none(nullptr);
  return current != nullptr ? *current : none;
}

}  // namespace microtrace
