#pragma once
#include "io/gltf/document/asset.hpp"

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

namespace microtrace::io::gltf {

/// Warns of items of an array that repeat earlier ones. `key` returns the value of an item.
template <typename Key>
void tolerate_repeated(Asset& asset, const Element& array, Key (JsonValue::*key)() const) {
  std::vector<std::pair<std::decay_t<Key>, std::size_t>> sorted;
  for (const JsonValue& item : array.value->items())
    sorted.emplace_back((item.*key)(), sorted.size());
  std::ranges::sort(sorted);
  for (std::size_t i = 1; i < sorted.size(); ++i) {
    if (sorted[i].first == sorted[i - 1].first)
      asset.tolerate(array.item(sorted[i].second), "repeats an earlier item");
  }
}

}  // namespace microtrace::io::gltf
