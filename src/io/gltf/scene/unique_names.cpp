#include "io/gltf/scene/unique_names.hpp"

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory_resource>
#include <string_view>
#include <tuple>
#include <unordered_map>

namespace microtrace::io::gltf {
namespace {

/// Compares millions of names in little memory.
bool are_unique(std::span<std::string* const> names) {
  struct Hashed {
    std::size_t hash;
    const std::string* name;
    bool operator==(const Hashed& other) const {
      return hash == other.hash && *name == *other.name;
    }
  };
  std::vector<Hashed> hashed;
  hashed.reserve(names.size());
  for (const std::string* const name : names)
    hashed.push_back({.hash = std::hash<std::string>{}(*name), .name = name});
  std::ranges::sort(hashed, [](const Hashed& a, const Hashed& b) {
    return std::tie(a.hash, *a.name) < std::tie(b.hash, *b.name);
  });
  return std::ranges::adjacent_find(hashed) == hashed.end();
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

void make_unique(std::span<std::string* const> names) {
  if (are_unique(names)) return;
  UniqueNames unique(names.size());
  for (std::string* const name : names) *name = unique.make(*name);
}

}  // namespace microtrace::io::gltf
