#include <microtrace/aov.hpp>

#include <array>
#include <cstddef>

namespace microtrace {
namespace {

struct Row {
  std::string_view name;
  std::array<std::string_view, 3> channels;
  std::size_t count;
};

const Row& row_of(Aov aov) {
  // Rows are in the order of Aov.
  static constexpr std::array kRows = {Row{"depth", {"Z"}, 1},
                                       Row{"distance", {"T"}, 1},
                                       Row{"position", {"X", "Y", "Z"}, 3},
                                       Row{"normal", {"X", "Y", "Z"}, 3},
                                       Row{"face_normal", {"X", "Y", "Z"}, 3},
                                       Row{"uv", {"U", "V"}, 2},
                                       Row{"barycentric", {"X", "Y", "Z"}, 3},
                                       Row{"albedo", {"R", "G", "B"}, 3},
                                       Row{"id", {"instance", "primitive", "material"}, 3}};
  static_assert(kRows.size() == kAovs.size());
  return kRows[static_cast<std::size_t>(aov)];
}

}  // namespace

std::string_view name_of(Aov aov) {
  return row_of(aov).name;
}

std::optional<Aov> aov_named(std::string_view name) {
  for (const Aov aov : kAovs) {
    if (name_of(aov) == name) return aov;
  }
  return std::nullopt;
}

std::span<const std::string_view> channels_of(Aov aov) {
  const Row& row = row_of(aov);
  return std::span(row.channels).first(row.count);
}

}  // namespace microtrace
