#include "base/text/nearest_name.hpp"

#include "base/text/printable.hpp"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace microtrace {
namespace {

constexpr std::size_t kMaxListed = 20;  // maximum number of names in a suggestion

/// Returns the least number of insertions, deletions and replacements of bytes that turn a into b
/// (V. Levenshtein, 1966), computed by the algorithm of R. Wagner and M. Fischer (1974).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i + 1);
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({replaced, row[j] + 1, diagonal + 1});
    }
  }
  return row.back();
}

std::size_t difference(std::size_t a, std::size_t b) {
  return a < b ? b - a : a - b;
}

}  // namespace

std::string_view nearest_name(std::string_view name, std::span<const std::string_view> known) {
  // Only distances up to 2, or up to a third of the length of a long name, count. The distance is
  // at least the difference of the lengths.
  std::size_t least = std::max<std::size_t>(2, name.size() / 3) + 1;
  std::string_view nearest;
  for (const std::string_view candidate : known) {
    if (difference(candidate.size(), name.size()) >= least) continue;
    const std::size_t distance = edit_distance(name, candidate);
    if (distance >= least || distance >= candidate.size()) continue;
    least = distance;
    nearest = candidate;
  }
  return nearest;
}

std::string suggestion(std::string_view name, std::span<const std::string_view> known) {
  if (known.empty()) return {};
  const std::string_view nearest = nearest_name(name, known);
  if (!nearest.empty())
    return std::string("; did you mean ").append(in_quotes(nearest)).append("?");

  std::string out = "; known are ";
  const std::size_t count = std::min(known.size(), kMaxListed);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) out += ", ";
    out += in_quotes(known[i]);
  }
  return known.size() > kMaxListed ? out.append(" and more") : out;
}

}  // namespace microtrace
