#pragma once
/// Which of many lights a point should ask (A. Conty Estevez and C. Kulla, Importance sampling of
/// many lights with adaptive tree splitting, 2018): a tree of boxes and cones, from the root to a
/// light at random by what each half may bring at most.

#include <microtrace/math.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include <glm/common.hpp>

namespace microtrace {

/// Directions within an angle theta_o of an axis. What is bounded shines from each up to theta_e
/// away, theta_o + theta_e at most pi.
struct LightCone {
  Vec3 axis{0, 0, 1};  ///< unit length
  float cos_o = 1;     ///< -1: all directions
  float cos_e = 0;
};

/// Where light comes from, and how much. What is made of it is float64: float32 has no place for
/// squares and products of many of its own numbers.
struct LightBounds {
  Vec3 low{0}, high{0};  ///< world space
  double power = 0;
  LightCone cone{};
  bool two_sided = false;  ///< shines about -axis too

  /// At least the light at p, but for the surface there and a constant; `n` is its unit normal, on
  /// either side.
  [[nodiscard]] double importance(const Vec3& p, const Vec3& n) const;
};

/// The nearest place that float32 has.
[[nodiscard]] inline Vec3 finite_point(const DVec3& p) {
  constexpr double most = std::numeric_limits<float>::max();
  return Vec3(glm::clamp(p, DVec3(-most), DVec3(most)));
}

/// The bounds of both.
[[nodiscard]] LightBounds united(const LightBounds& a, const LightBounds& b);

/// Made once; any number of threads may ask it.
class LightTree {
 public:
  /// One for each light, at least one, in their order; each power is above 0.
  explicit LightTree(const std::vector<LightBounds>& lights);

  /// Of all together.
  [[nodiscard]] double importance(const Vec3& p, const Vec3& n) const {
    return nodes_.front().bounds.importance(p, n);
  }

  struct Choice {
    std::size_t light;
    double share;  ///< of samples at that place, above 0
  };
  /// u in [0, 1). Nothing if none reaches that point.
  [[nodiscard]] std::optional<Choice> choose(const Vec3& p, const Vec3& n, float u) const;

  /// With which choose() gives that light there.
  [[nodiscard]] double share(std::size_t light, const Vec3& p, const Vec3& n) const;

 private:
  struct Node {
    LightBounds bounds;
    std::uint32_t second = 0;  ///< child; the first stands behind its parent
    std::uint32_t light = 0;   ///< of a leaf
    bool is_leaf = true;
  };

  void build(const std::vector<LightBounds>& lights, std::vector<std::uint32_t>& order,
             std::size_t begin, std::size_t end, std::uint64_t trail, unsigned depth);
  /// Of the first child of an inner node; negative if nothing comes from either.
  [[nodiscard]] float first_share(const Node& node, const Vec3& p, const Vec3& n) const;

  std::vector<Node> nodes_;
  /// By light: a bit for each step down from the root, the least first; 1 is the second child.
  std::vector<std::uint64_t> trails_;
};

}  // namespace microtrace
