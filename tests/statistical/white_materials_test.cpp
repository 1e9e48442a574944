// The table of albedos in docs/light.md: random white materials of each of its kinds must be within
// the ranges that it states.

#include "support/cases/adversarial_rays.hpp"
#include "support/effort.hpp"
#include "support/shading/furnace.hpp"
#include "support/source_folder.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace::bsdf {
namespace {

class Random : public adversarial::Random {
 public:
  explicit Random(const adversarial::Random& other) : adversarial::Random(other) {}
  float in(double lo, double hi) { return static_cast<float>(lo + (hi - lo) * unit()); }
};

struct Material {
  Parameters base;
  std::optional<Layers> layers{};
};

/// Returns a white dielectric with a random roughness and index of refraction, the thin wall or
/// opaque body of which the other kinds are made.
Parameters dielectric(Random& random, float ior) {
  const float r = (ior - 1) / (ior + 1);
  Parameters p{.base_color = Vec3(1), .roughness = random.in(0.03, 1)};
  p.dielectric.f0 = Vec3(r * r);
  return p;
}
float any_ior(Random& random) {
  return random.in(1.1, 2.4);
}
Parameters dielectric(Random& random) {
  return dielectric(random, any_ior(random));
}
Parameters metal(Random& random) {
  Parameters p = dielectric(random);
  p.metallic = 1;
  return p;
}
ThinFilm<1> film(Random& random, double least_ior, double greatest_ior) {
  return {.share = random.one_in(2) ? 1 : random.in(0, 1),
          .ior = random.in(least_ior, greatest_ior),
          .thickness = random.in(50, 1000)};
}

/// A refracting boundary, seen from outside of the body or from inside.
enum class Side { outside, inside };
Parameters glass(Random& random, Side side) {
  const float ior = any_ior(random);
  Parameters p = dielectric(random, ior);
  p.transmission = 1;
  p.eta = side == Side::outside ? ior : 1 / ior;
  return p;
}
Layers on(Side side) {
  return {.side = side == Side::outside ? LayerSide::above : LayerSide::below};
}
void add_coat(Random& random, Layers& layers) {
  layers.coat = random.one_in(2) ? 1 : random.in(0, 1);
  layers.coat_roughness = random.in(0, 1);
}
void add_sheen(Random& random, Layers& layers) {
  layers.sheen = Vec3(random.one_in(2) ? 1 : random.in(0, 1));
  layers.sheen_roughness = random.in(0.3, 1);
}

/// Returns a material of the kinds that lose least.
Material common(Random& random) {
  const bool is_metal = random.one_in(5);
  Parameters p = is_metal ? metal(random) : dielectric(random);
  const int kind = random.between(0, 3);
  if (kind == 1) p.metallic = random.in(0, 1);
  if (kind == 2) p.transmission = 1;
  if (kind == 3) p.diffuse_transmission = random.in(0, 1);
  const bool may_have_film = (is_metal && kind == 0) || (!is_metal && kind == 2);
  if (may_have_film && random.one_in(2)) p.film = film(random, 1, 2.5);
  return {p};
}

/// A row of the table.
struct Kind {
  const char* name;
  std::function<Material(Random&)> make;
  /// True for materials that are colored, of which only the brightest channel is white.
  bool is_colored = false;
};

std::vector<Kind> kinds() {
  const auto filmed = [](double least_ior, double greatest_ior) {
    return [=](Random& random) {
      Parameters p = dielectric(random);
      p.film = film(random, least_ior, greatest_ior);
      return Material{p};
    };
  };
  const auto coated = [](Random& random) {
    Layers coat;
    add_coat(random, coat);
    const Parameters base = random.one_in(2) ? metal(random) : dielectric(random);
    return Material{base, coat};
  };
  const auto cloth = [](double least_roughness, double greatest_roughness) {
    return [=](Random& random) {
      Layers sheen;
      add_sheen(random, sheen);
      sheen.sheen_roughness = random.in(least_roughness, greatest_roughness);
      const Parameters base = random.one_in(2) ? metal(random) : dielectric(random);
      return Material{base, sheen};
    };
  };
  const auto specular_glass = [](Side side) {
    return [=](Random& random) {
      Parameters p = glass(random, side);
      if (random.one_in(2)) p.dielectric.f90 = random.one_in(3) ? 0 : random.in(0, 1);
      if (random.one_in(2)) p.dielectric.f0 = Vec3(random.in(0, 1));
      p.dielectric.f0 *= p.dielectric.f90;
      return Material{p};
    };
  };
  const auto half_glass = [](Side side) {
    return [=](Random& random) {
      Parameters p = glass(random, side);
      p.transmission = random.in(0, 1);
      if (random.one_in(2)) p.diffuse_transmission = random.in(0, 1);
      return Material{p};
    };
  };
  const auto covered_glass = [](Side side, double most_roughness) {
    return [=](Random& random) {
      Material m{glass(random, side), on(side)};
      m.base.roughness = random.in(0.03, most_roughness);
      const int kind = random.between(0, 2);
      if (kind != 0) add_coat(random, *m.layers);
      if (kind != 1) add_sheen(random, *m.layers);
      m.base.transmission = random.one_in(2) ? 1 : random.in(0, 1);
      return m;
    };
  };
  const auto filmed_glass = [](Side side) {
    return [=](Random& random) {
      Parameters p = glass(random, side);
      p.film = film(random, 1.2, 2.5);
      return Material{p};
    };
  };
  const auto brushed = [](auto base, double least, double most) {
    return [=](Random& random) {
      Material m{base(random)};
      m.base.anisotropy = random.in(least, most);
      const double turn = 2 * kPi * random.unit();
      m.base.along = Vec3(std::cos(turn), std::sin(turn), 0);
      return m;
    };
  };
  const auto glass_on = [](Side side) {
    return [=](Random& random) { return glass(random, side); };
  };
  const auto opaque = [](Random& random) { return dielectric(random); };
  return {
      {"metal, also under films; dielectric; mixtures; thin walls, also under films; paper",
       common},
      {"film of an index of at least 1.2 on a dielectric", filmed(1.2, 2.5), true},
      {"film of a lower index on a dielectric", filmed(1, 1.2), true},
      {"clear coat on metal or dielectric", coated},
      {"sheen of a roughness of at least 0.3 on metal or dielectric", cloth(0.3, 1)},
      {"smoother sheen", cloth(0, 0.3)},
      {"rough glass from outside", specular_glass(Side::outside)},
      {"rough glass from inside", specular_glass(Side::inside)},
      {"half-transmitting body from outside", half_glass(Side::outside)},
      {"half-transmitting body from inside", half_glass(Side::inside)},
      {"coat or sheen over glass, from outside", covered_glass(Side::outside, 1)},
      {"coat or sheen over glass of a roughness up to 0.1, from inside",
       covered_glass(Side::inside, 0.1)},
      {"coat or sheen over rougher glass, from inside", covered_glass(Side::inside, 1)},
      {"film of an index of at least 1.2 on glass, from outside", filmed_glass(Side::outside),
       true},
      {"film of an index of at least 1.2 on glass, from inside", filmed_glass(Side::inside), true},
      {"anisotropic metal, strength up to 0.8", brushed(metal, 0, 0.8)},
      {"anisotropic metal, strength above 0.8", brushed(metal, 0.8, 1)},
      {"anisotropic dielectric, strength up to 0.8", brushed(opaque, 0, 0.8)},
      {"anisotropic dielectric, strength above 0.8", brushed(opaque, 0.8, 1)},
      {"anisotropic glass, strength 0.5, from outside", brushed(glass_on(Side::outside), 0.5, 0.5)},
      {"anisotropic glass, strength 0.5, from inside", brushed(glass_on(Side::inside), 0.5, 0.5)},
  };
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), most = -least;

  void add(double x) {
    least = std::min(least, x);
    most = std::max(most, x);
  }
  /// True if `other` is within this range, except for noise.
  [[nodiscard]] bool contains(const Range& other) const {
    constexpr double kNoise = 0.001;
    return other.least > least - kNoise && other.most < most + kNoise;
  }
};

/// The directions of a column of the table, by their angles above the horizon in degrees.
struct Directions {
  double lowest, highest;
};
constexpr std::array kDirections{Directions{6, 90}, Directions{1, 6}};

using Row = std::array<Range, kDirections.size()>;

/// Reads the rows of the table, which state two ranges.
std::map<std::string, Row> documented_rows() {
  std::ifstream file(tests::source_folder() / "docs/light.md");
  std::map<std::string, Row> rows;
  for (std::string line; std::getline(file, line);) {
    const std::size_t end = line.find(" | ", 2);
    if (!line.starts_with("| ") || end == std::string::npos) continue;
    Row row;
    if (std::sscanf(line.c_str() + end, " | %lf to %lf | %lf to %lf", &row[0].least, &row[0].most,
                    &row[1].least, &row[1].most) == 4)
      rows[line.substr(2, end - 2)] = row;
  }
  return rows;
}

/// Returns the albedos of the color channels for light from wo.
Range albedos(const Kind& kind, const Material& m, const Vec3& wo, std::uint32_t samples) {
  const DVec3 sum = furnace(m.base, m.layers, wo, samples);
  Range result;
  if (kind.is_colored) {
    result.add(std::max({sum.x, sum.y, sum.z}));
  } else {
    for (int c = 0; c < 3; ++c) result.add(sum[c]);
  }
  return result;
}

TEST(WhiteMaterials, HaveTheDocumentedAlbedos) {
  const std::map<std::string, Row> rows = documented_rows();
  EXPECT_EQ(rows.size(), kinds().size());
  const int count = oracle::case_count(25e-6);
  std::uint64_t test = 0;
  for (const Kind& kind : kinds()) {
    Random random(oracle::announced_random(++test));
    ASSERT_TRUE(rows.contains(kind.name)) << kind.name;
    Row found;
    for (int i = 0; i < count; ++i) {
      const Material m = kind.make(random);
      for (std::size_t k = 0; k < kDirections.size(); ++k) {
        const Range& stated = rows.at(kind.name)[k];
        const double above = random.in(kDirections[k].lowest, kDirections[k].highest);
        const Vec3 wo = direction((90 - above) * kPi / 180, 2 * kPi * random.unit());
        // Starts with few samples, and uses more if the result is not in the range.
        Range range = albedos(kind, m, wo, 1U << 13U);
        if (!stated.contains(range)) range = albedos(kind, m, wo, 1U << 18U);
        EXPECT_TRUE(stated.contains(range))
            << kind.name << ": " << range.least << " to " << range.most << " in direction "
            << kDirections[k].lowest << ", material " << i;
        found[k].add(range.least);
        found[k].add(range.most);
      }
    }
    std::cout << "| " << kind.name;
    for (const Range& range : found) std::cout << " | " << range.least << " to " << range.most;
    std::cout << " |\n";
  }
}

}  // namespace
}  // namespace microtrace::bsdf
