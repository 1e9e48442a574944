#pragma once
/// The reflectance of a half-space that scatters isotropically (S. Chandrasekhar, Radiative
/// transfer, 1950).

#include <cmath>
#include <cstddef>
#include <vector>

namespace microtrace {

/// Chandrasekhar's H-function, by iteration of its integral equation (section 38).
class HFunction {
 public:
  /// `albedo` is that of a single scattering event.
  explicit HFunction(double albedo, int iterations = 60) : albedo_(albedo), h_(kSteps, 1.0) {
    for (int i = 0; i < iterations; ++i) {
      std::vector<double> next;
      for (std::size_t k = 0; k < kSteps; ++k) next.push_back((*this)(node(k)));
      // The mean converges also for albedo 1, at which plain iteration oscillates.
      for (std::size_t k = 0; k < kSteps; ++k) h_[k] = (h_[k] + next[k]) / 2;
    }
  }

  [[nodiscard]] double operator()(double cosine) const {
    double sum = 0;
    for (std::size_t k = 0; k < kSteps; ++k) sum += node(k) * h_[k] / (cosine + node(k)) / kSteps;
    return 1 / (std::sqrt(1 - albedo_) + albedo_ / 2 * sum);
  }

  /// The reflected fraction of light that arrives at an angle with this cosine. Also the radiance
  /// at this angle under uniform light.
  [[nodiscard]] double reflected(double cosine) const {
    return 1 - (*this)(cosine)*std::sqrt(1 - albedo_);
  }
  /// The reflected fraction of uniform light.
  [[nodiscard]] double mean_reflected() const {
    double sum = 0;
    for (std::size_t k = 0; k < kSteps; ++k) sum += 2 * node(k) * reflected(node(k)) / kSteps;
    return sum;
  }

 private:
  static constexpr std::size_t kSteps = 200;
  static double node(std::size_t k) { return (static_cast<double>(k) + 0.5) / kSteps; }

  double albedo_;
  std::vector<double> h_;  // at the nodes
};

}  // namespace microtrace
