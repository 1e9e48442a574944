#include "io/gltf/scene/unique_names.hpp"

#include "base/memory_account.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory_resource>
#include <string_view>
#include <unordered_map>

namespace microtrace::io::gltf {
namespace {

using NameOf = std::function<std::string(std::size_t)>;

/// Compares millions of names in little memory. Equal hashes of different names are so rare that
/// false is returned for them.
bool are_unique(std::size_t count, const NameOf& name) {
  std::vector<std::size_t> hashes(count);
  for (std::size_t i = 0; i < count; ++i) hashes[i] = std::hash<std::string>{}(name(i));
  std::ranges::sort(hashes);
  return std::ranges::adjacent_find(hashes) == hashes.end();
}

class UniqueNames {
 public:
  explicit UniqueNames(std::size_t count) { uses_.reserve(count); }

  std::string make(const std::string& name) {
    const auto first = uses_.find(std::string_view(name));
    if (first == uses_.end()) {
      uses_.emplace(name, 1);
      return name;
    }
    std::size_t& use = first->second;  // the reference stays valid when names are inserted
    std::string result;
    do {
      result = name + " (" + std::to_string(++use) + ")";
    } while (!uses_.emplace(result, 1).second);
    return result;
  }

 private:
  struct Hash {
    using is_transparent = void;
    // Not noexcept, so that libstdc++ stores the hashes. This avoids most string comparisons.
    std::size_t operator()(std::string_view name) const {
      return std::hash<std::string_view>{}(name);
    }
  };

  std::pmr::monotonic_buffer_resource memory_;  // frees all names at once
  std::pmr::unordered_map<std::pmr::string, std::size_t, Hash, std::equal_to<>> uses_{&memory_};
};

}  // namespace

void make_unique(std::size_t count, const NameOf& name,
                 const std::function<void(std::size_t, const std::string&)>& rename) {
  if (are_unique(count, name)) return;
  constexpr std::uint64_t kBytesOfUse = 128;
  std::uint64_t bytes = 0;
  for (std::size_t i = 0; i < count; ++i) bytes += kBytesOfUse + 2 * name(i).size();
  constexpr std::uint64_t kBytesOfText = 64;  // a renamed object's own text and its allocation
  constexpr const char* kNames = "the names of the scene";
  const MemoryAccount room = temporary_memory(bytes, kNames);
  UniqueNames unique(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::string own = name(i), made = unique.make(own);
    if (made == own) continue;
    take_memory(kBytesOfText + made.size(), kNames);
    rename(i, made);
  }
}

}  // namespace microtrace::io::gltf
