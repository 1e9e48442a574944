#include "arrays.hpp"

#include <mutex>
#include <unordered_map>

namespace microtrace::python {
namespace {

struct Owners {
  std::mutex mutex;
  std::unordered_map<const void*, std::weak_ptr<const void>> by_data;
  std::size_t limit = 64;  // expired entries are removed when there are this many
};

/// The owners are never destroyed, because arrays may outlive this module.
Owners& owners() {
  static auto* const result = new Owners;
  return *result;
}

}  // namespace

std::shared_ptr<const void> owner_of(const void* data) {
  Owners& all = owners();
  const std::scoped_lock lock(all.mutex);
  const auto at = all.by_data.find(data);
  return at == all.by_data.end() ? nullptr : at->second.lock();
}

void remember_owner(const void* data, const std::shared_ptr<const void>& owner) {
  Owners& all = owners();
  const std::scoped_lock lock(all.mutex);
  if (all.by_data.size() >= all.limit) {
    std::erase_if(all.by_data, [](const auto& entry) { return entry.second.expired(); });
    all.limit = 2 * all.by_data.size() + 64;
  }
  all.by_data[data] = owner;
}

}  // namespace microtrace::python
