// White furnace test of clear coats, which may have another normal than the base.

#include "support/pi.hpp"
#include "support/shading/furnace.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

TEST(CoatFurnace, ClearCoat) {
  for (const float roughness : {0.0F, 0.2F, 0.6F}) {
    for (const float coat : {0.5F, 1.0F}) {
      const Layers layers{.coat = coat, .coat_roughness = roughness};
      expect_white("coat on metal", kMetal, layers, 0.004);
      expect_white("coat on a dielectric", kWhite, layers, 0.004);
    }
  }
}

/// The mean, least and greatest albedo for directions up to 70 degrees from the shading normal and
/// 84 degrees from the coat's.
struct TurnedAlbedo {
  double mean = 0, least = 1, greatest = 0;
};
TurnedAlbedo albedo_under_turned_coat(const Layers& layers, const Parameters& p, double angle) {
  TurnedAlbedo result;
  double weights = 0;
  for (const double theta : {0.05, 0.3, 0.5, 0.7, 0.9, 1.05, 1.2}) {
    for (const double azimuth : {0.3, 1.1, 1.9, 2.7, 3.4}) {
      const Vec3 wo = direction(theta, 0.3), n = direction(angle, azimuth);
      if (glm::dot(wo, n) < 0.1F) continue;
      const double white = furnace(p, layers, wo, 1U << 14U, n).x;
      const double weight = std::sin(theta) * std::cos(theta);
      weights += weight;
      result.mean += weight * white;
      result.least = std::min(result.least, white);
      result.greatest = std::max(result.greatest, white);
    }
  }
  result.mean /= weights;
  return result;
}

// A coat or a base with a normal map has another normal than the layer beside it nearly everywhere.
TEST(CoatFurnace, CoatsWithTheirOwnNormal) {
  struct Bounds {
    double angle, dielectric, metal;  ///< least means
  };
  for (const float coat_roughness : {0.05F, 0.5F}) {
    const Layers layers{.coat = 1, .coat_roughness = coat_roughness};
    for (Parameters p : {kMetal, kWhite}) {
      for (const float roughness : {0.05F, 0.5F, 0.8F}) {
        p.roughness = roughness;
        for (const Bounds& bounds : {Bounds{0.01, 0.998, 0.998}, Bounds{0.05, 0.998, 0.995},
                                     Bounds{0.12, 0.997, 0.990}, Bounds{0.3, 0.996, 0.976}}) {
          const TurnedAlbedo albedo = albedo_under_turned_coat(layers, p, bounds.angle);
          const std::string place = std::to_string(bounds.angle) + ' ' +
                                    std::to_string(coat_roughness) + ' ' +
                                    std::to_string(roughness) + ' ' + std::to_string(p.metallic);
          EXPECT_GT(albedo.mean, p.metallic > 0 ? bounds.metal : bounds.dielectric) << place;
          EXPECT_LT(albedo.greatest, p.metallic > 0 ? kMostUnderTurnedCoat : 1.005) << place;
        }
      }
    }
  }
}

// The normal map of the base doesn't change what a smooth coat reflects.
TEST(CoatFurnace, CoatsReflectIndependentlyOfTheBase) {
  const Parameters black{.base_color = Vec3(0), .dielectric = {.f0 = Vec3(0), .f90 = 0}};
  for (const float coat_roughness : {0.05F, 0.3F}) {
    const Layers layers{.coat = 1, .coat_roughness = coat_roughness};
    for (const double theta : {0.2, 0.8, 1.2, 1.4}) {
      const double expected = furnace(black, layers, direction(theta), 1U << 16U).x;
      // Turns the base, so wo and the coat's normal are at other angles to it.
      for (const double angle : {0.1, 0.4}) {
        for (const bool is_toward : {false, true}) {
          const double turned = is_toward ? theta - angle : theta + angle;
          if (turned > 1.55) continue;
          const Vec3 normal = direction(angle, is_toward ? kPi : 0);
          const double seen = furnace(black, layers, direction(turned, 0), 1U << 16U, normal).x;
          EXPECT_NEAR(seen, expected, 0.01 * expected + 0.0003) << theta << ' ' << angle;
        }
      }
    }
  }
}

}  // namespace
}  // namespace microtrace::bsdf
