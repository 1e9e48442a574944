#include <microtrace/explain.hpp>

#include <algorithm>
#include <array>

namespace microtrace {
namespace {

constexpr std::array<std::string_view, 4> kStages = {"float32", "float64", "grid", "dyadic"};
constexpr std::array<std::string_view, 7> kVerdicts = {
    "visible", "seen_through", "hidden", "culled", "masked", "transparent", "repeated"};
constexpr std::array<std::string_view, 4> kOrders = {"first", "bounds", "exact", "tie"};
constexpr std::array<std::string_view, 3> kAlphaModes = {"opaque", "mask", "blend"};

// The corners opposite to the edges, and the edges, in the order of TriangleNumbers::volumes.
constexpr std::array<std::string_view, 3> kCorners = {"a", "b", "c"}, kEdges = {"bc", "ca", "ab"};

}  // namespace

std::string_view name_of(Stage stage) {
  return kStages.at(static_cast<std::size_t>(stage));
}
std::string_view name_of(Verdict verdict) {
  return kVerdicts.at(static_cast<std::size_t>(verdict));
}
std::string_view name_of(OrderDecision decision) {
  return kOrders.at(static_cast<std::size_t>(decision));
}
std::string_view name_of(AlphaMode mode) {
  return kAlphaModes.at(static_cast<std::size_t>(mode));
}

std::string place_in_triangle(const TriangleNumbers& n) {
  const auto zeros = std::ranges::count(n.signs, 0);
  if (zeros == 3) {
    return n.stretch ? "along the triangle, in its plane" : "outside of the triangle, in its plane";
  }
  const int side = n.plane.slope_sign;
  if (side == 0) return "outside of the triangle, parallel to its plane";
  std::string outside;
  std::size_t first_zero = 3, nonzero = 3;
  for (std::size_t i = 0; i < 3; ++i) {
    if (n.signs[i] == 0) first_zero = std::min(first_zero, i);
    if (n.signs[i] != 0) nonzero = i;
    if (n.signs[i] * side < 0)
      outside.append(outside.empty() ? "outside of edge " : " and edge ").append(kEdges[i]);
  }
  if (!outside.empty()) return outside;
  if (zeros == 2) return "on vertex " + std::string(kCorners[nonzero]);
  return zeros == 1 ? "on edge " + std::string(kEdges[first_zero]) : "inside";
}

}  // namespace microtrace
