// Compares the albedos that the renderer evaluates from its tables with the integrals that the
// tables approximate.

#include "render/bsdf/anisotropic_albedo.hpp"
#include "render/bsdf/coating.hpp"
#include "render/bsdf/refraction_loss.hpp"
#include "render/bsdf/sheen.hpp"
#include "support/shading/scattering.hpp"
#include "support/source_folder.hpp"
#include "tables/albedos.hpp"
#include "tables/header_text.hpp"
#include "tables/stated_errors.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <iterator>
#include <numbers>
#include <string>

#include <gmock/gmock.h>

namespace microtrace::bsdf {
namespace {

using tables::Quadrature;
using testing::HasSubstr;

class Errors {
 public:
  void add(double value, double integral) {
    const double error = value - integral;
    above_ = std::max(above_, error);
    below_ = std::max(below_, -error);
    squares_ += error * error;
    ++count_;
  }

  /// Checks that measured errors do not exceed the stated ones and are not much smaller.
  void expect(const tables::StatedError& stated, const char* what) const {
    constexpr double rounding = 1e-6;  // rounding error of float32
    const double rms = std::sqrt(squares_ / count_);
    EXPECT_LE(above_, stated.above + rounding) << what;
    EXPECT_LE(below_, stated.below + rounding) << what;
    EXPECT_LE(rms, stated.rms) << what;
    EXPECT_GE(rms, 0.5 * stated.rms) << what << ": state a smaller error";
  }

 private:
  double above_ = 0, below_ = 0, squares_ = 0;
  int count_ = 0;
};

/// Generates multiples of an irrational number modulo 1, which are spread evenly.
class Spread {
 public:
  explicit Spread(double step) : step_(step) {}

  double operator()() {
    at_ += step_;
    at_ -= std::floor(at_);
    return at_;
  }

 private:
  double step_, at_ = 0;
};

/// Returns the generator for the k-th of n numbers. Its step is a power of a root of x^(n+1) = x +
/// 1 (M. Roberts, The unreasonable effectiveness of quasirandom sequences, 2018).
Spread spread(int k, int n) {
  double root = 1.5;
  for (int i = 0; i < 50; ++i) root = std::pow(1 + root, 1.0 / (n + 1));
  return Spread(std::pow(root, -k - 1));
}

Vec3 vector(const tables::Direction& w) {
  return {static_cast<float>(w.x), static_cast<float>(w.y), static_cast<float>(w.z)};
}

/// Inverts s = z (1 + b) / (z + b).
double bent_cosine(double s, double b) {
  return std::min(b * s / (1 + b - s), 1.0);
}

TEST(TableErrors, IntegralsConverge) {
  const Quadrature coarse = tables::graded(40), fine = tables::graded(160);
  for (const double alpha : {0.001, 0.03, 0.3, 1.0}) {
    const tables::Alphas alphas{.x = alpha, .y = std::sqrt(alpha)};
    for (const double z : {0.0, 0.001, 0.03, 0.3, 0.8, 1.0}) {
      const tables::Direction wo{
          .x = 0.6 * std::sqrt(1 - z * z), .y = 0.8 * std::sqrt(1 - z * z), .z = z};
      const tables::Albedo a = ggx_albedo(alphas, wo, coarse), b = ggx_albedo(alphas, wo, fine);
      EXPECT_NEAR(a.f1, b.f1, 2e-6) << alpha << ' ' << z;
      EXPECT_NEAR(a.schlick, b.schlick, 2e-6) << alpha << ' ' << z;
      for (const double eta : {1.1, 2.0, 1 / 1.1, 0.5}) {
        EXPECT_NEAR(tables::refraction_loss(alpha, z, eta, tables::graded(24)).loss,
                    tables::refraction_loss(alpha, z, eta, fine).loss, 1.5e-3)
            << alpha << ' ' << z << ' ' << eta;
      }
    }
  }
}

TEST(TableErrors, Ggx) {
  const Quadrature points = tables::graded(32);
  Errors f1, schlick;
  Spread roughnesses = spread(0, 2), steps = spread(1, 2);
  for (int i = 0; i < 3000; ++i) {
    const double roughness = roughnesses(), s = steps(), alpha = tables::alpha_of(roughness);
    const GgxAlbedo<1> albedo(Ggx<1>(static_cast<float>(roughness)));
    const tables::Alphas alphas{.x = alpha, .y = alpha};
    const double bent = bent_cosine(s, alpha), square = s * s;
    f1.add(albedo.at(static_cast<float>(bent)).f1,
           ggx_albedo(alphas, tables::tilted(bent), points).f1);
    schlick.add(albedo.at(static_cast<float>(square)).schlick,
                ggx_albedo(alphas, tables::tilted(square), points).schlick);
  }
  f1.expect(tables::kGgxF1Error, "F = 1");
  schlick.expect(tables::kGgxSchlickError, "Schlick");
}

TEST(TableErrors, GgxMeans) {
  const Quadrature cosines = tables::graded(200);
  Errors f1, schlick;
  Spread roughnesses = spread(0, 1);
  for (int i = 0; i < 500; ++i) {
    const GgxAlbedo<1> albedo(Ggx<1>(static_cast<float>(roughnesses())));
    double white = 0, edge = 0;
    for (std::size_t k = 0; k < cosines.at.size(); ++k) {
      const double weight = 2 * cosines.at[k] * cosines.weights[k];
      const Albedo<1> there = albedo.at(static_cast<float>(cosines.at[k]));
      white += weight * there.f1;
      edge += weight * there.schlick;
    }
    f1.add(albedo.mean().f1, white);
    schlick.add(albedo.mean().schlick, edge);
  }
  f1.expect(tables::kGgxMeanF1Error, "F = 1");
  schlick.expect(tables::kGgxMeanSchlickError, "Schlick");
}

// A lobe whose albedo is the loss divided by the tabulated mean loss must return the energy that
// single scattering loses.
TEST(TableErrors, WhiteMetalConservesEnergy) {
  const Quadrature points = tables::graded(32), cosines = tables::graded(64);
  double least = 1, most = 1;
  for (int i = 1; i <= 300; ++i) {
    const double roughness = i / 300.0, alpha = tables::alpha_of(roughness);
    const GgxAlbedo<1> albedo(Ggx<1>(static_cast<float>(roughness)));
    double lost = 0;
    for (std::size_t k = 0; k < cosines.at.size(); ++k) {
      const double z = cosines.at[k];
      lost += 2 * z * cosines.weights[k] * (1 - albedo.at(static_cast<float>(z)).f1);
    }
    const double returned = lost / (1 - albedo.mean().f1);
    for (int k = 6; k <= 40; ++k) {
      const double z = k * k / 1600.0;
      const double once = ggx_albedo({.x = alpha, .y = alpha}, tables::tilted(z), points).f1;
      const double all = once + (1 - albedo.at(static_cast<float>(z)).f1) * returned;
      least = std::min(least, all);
      most = std::max(most, all);
    }
  }
  EXPECT_GT(least, tables::kLeastWhiteMetal);
  EXPECT_LT(most, tables::kMostWhiteMetal);
  EXPECT_LT(least, tables::kLeastWhiteMetal + 0.001) << "state a smaller loss";
}

TEST(TableErrors, Sheen) {
  const Quadrature azimuths = tables::graded(32), cell = tables::graded(10);
  constexpr std::size_t cells = kSheenColumns - 1;
  Errors errors;
  double most = 0;
  Spread rows = spread(0, 2), columns = spread(1, 2);
  for (int i = 0; i < 400; ++i) {
    const double row = rows(), roughness = 0.05 + 0.95 * row * row, b = roughness / 2;
    const tables::Direction wo = tables::tilted(std::max(bent_cosine(columns(), b), 1e-4));
    const SheenLobe<1> sheen(static_cast<float>(roughness));
    double sum = 0;
    for (std::size_t k = 0; k < cells * cell.at.size(); ++k) {
      const std::size_t column = k / cell.at.size(), at = k % cell.at.size();
      const double s = (static_cast<double>(column) + cell.at[at]) / cells;
      const double slope = b * (1 + b) / ((1 + b - s) * (1 + b - s)) / cells;
      const tables::Direction in = tables::tilted(bent_cosine(s, b));
      double around = 0;
      for (std::size_t m = 0; m < azimuths.at.size(); ++m) {
        const double turn = std::numbers::pi * azimuths.at[m];
        const Vec3 wi = vector({.x = in.x * std::cos(turn), .y = in.x * std::sin(turn), .z = in.z});
        around += azimuths.weights[m] *
                  double{sheen.reflectance(vector(wo), wi, unit<1>(vector(wo) + wi))};
      }
      sum += 2 * std::numbers::pi * around * in.z * slope * cell.weights[at];
    }
    errors.add(sheen.albedo(static_cast<float>(wo.z)), sum);
    most = std::max(most, sum);
  }
  errors.expect(tables::kSheenError, "sheen");
  EXPECT_LE(most, tables::kMostSheen);
}

TEST(TableErrors, EnergyDeficitUnderACoat) {
  const Quadrature points = tables::graded(32);
  Errors f1, schlick;
  Spread roughnesses = spread(0, 3), coats = spread(1, 3), roots = spread(2, 3);
  for (int i = 0; i < 1000; ++i) {
    const double roughness = roughnesses(), root = roots(), alpha = tables::alpha_of(roughness);
    const Coating<1> coating(
        surface_of({.roughness = static_cast<float>(roughness)},
                   {.coat = 1, .coat_roughness = static_cast<float>(coats())}));
    const tables::Direction wo = tables::tilted(root * root);
    const float here = coating.transmittance(vector(wo));
    double white = 0, edge = 0;
    over_reflections({.x = alpha, .y = alpha}, wo, points, wo.z, [&](const tables::Reflection& r) {
      const double less = std::max(here - coating.transmittance(vector(r.wi)), 0.0F);
      white += r.weight * less;
      edge += r.weight * less * tables::fifth_power(r.x);
    });
    const Albedo<1> got = coating.deficit(static_cast<float>(wo.z));
    f1.add(got.f1, white);
    schlick.add(got.schlick, edge);
  }
  f1.expect(tables::kDeficitF1Error, "F = 1");
  schlick.expect(tables::kDeficitSchlickError, "Schlick");
}

/// The place of a random refracting boundary in the tables, with an index of at least 1.003.
struct AnyBoundary {
  double roughness, z, eta;

  float r() const { return static_cast<float>((eta - 1) / (eta + 1)); }
  float loss(float f0, float f90) const {
    using Loss = RefractionLoss<1>;
    const Loss loss({.roughness = static_cast<float>(roughness),
                     .eta = static_cast<float>(eta),
                     .dielectric = {.f0 = f0, .f90 = f90}},
                    [&](float) { return Loss::F0Range{.least = f0, .most = f0}; });
    return loss.above(static_cast<float>(z));
  }
  tables::RefractionLoss integral() const {
    return tables::refraction_loss(tables::alpha_of(roughness), z, eta, points);
  }
  static inline const Quadrature points = tables::graded(24);
};

class AnyBoundaries {
 public:
  explicit AnyBoundaries(bool within) : within_(within) {}

  AnyBoundary operator()() {
    constexpr double least = 0.0775;  // critical cosine for an index of 1.003
    const double critical = least + (kGreatestCritical - least) * criticals_();
    const double inverse = std::sqrt(1 - critical * critical);
    const double roughness = roughnesses_(), column = columns_(), part = 2 * column - 1;
    const double z = !within_   ? column * column
                     : part < 0 ? critical * (1 + part) * (1 + part)
                                : critical + (1 - critical) * part * part;
    return {.roughness = roughness, .z = z, .eta = within_ ? inverse : 1 / inverse};
  }

 private:
  bool within_;
  Spread criticals_ = spread(0, 3), roughnesses_ = spread(1, 3), columns_ = spread(2, 3);
};

TEST(TableErrors, RefractionLoss) {
  for (const bool within : {false, true}) {
    Errors errors;
    AnyBoundaries boundaries(within);
    for (int i = 0; i < 4000; ++i) {
      const AnyBoundary boundary = boundaries();
      errors.add(boundary.loss(boundary.r() * boundary.r(), 1), boundary.integral().loss);
    }
    errors.expect(within ? tables::kLossWithinError : tables::kLossOutsideError,
                  within ? "within" : "outside");
  }
}

TEST(TableErrors, RefractionLossOfOtherFresnelTerms) {
  for (const bool within : {false, true}) {
    Errors errors;
    AnyBoundaries boundaries(within);
    Spread f0s = spread(0, 2), f90s = spread(1, 2);
    for (int i = 0; i < 4000; ++i) {
      const AnyBoundary boundary = boundaries();
      const double f90 = i % 2 == 0 ? 1 : f90s(), f0 = f0s() * f90, r = boundary.r();
      const tables::RefractionLoss at = boundary.integral();
      errors.add(boundary.loss(static_cast<float>(f0), static_cast<float>(f90)),
                 at.loss + (f0 - r * r) * at.by_f0 + (f90 - 1) * at.by_f90);
    }
    errors.expect(within ? tables::kAnyLossWithinError : tables::kAnyLossOutsideError,
                  within ? "within" : "outside");
  }
}

TEST(TableErrors, AnisotropicGgx) {
  const Quadrature points = tables::graded(24);
  Errors f1, schlick;
  Spread roughnesses = spread(0, 4), strengths = spread(1, 4), turns = spread(2, 4),
         steps = spread(3, 4);
  for (int i = 0; i < 4000; ++i) {
    const AnisotropicGgx<1> ggx(static_cast<float>(roughnesses()), static_cast<float>(strengths()),
                                {1, 0});
    const double turn = turns() * std::numbers::pi / 2, s = steps();
    const double x = std::cos(turn), y = std::sin(turn);
    const double alpha = ggx.alpha(vector({.x = x, .y = y, .z = 0}));
    const double z = i % 2 == 0 ? s * s : bent_cosine(s, alpha), across = std::sqrt(1 - z * z);
    const tables::Direction wo{.x = across * x, .y = across * y, .z = z};
    const tables::Albedo wanted =
        ggx_albedo({.x = ggx.along_alpha(), .y = ggx.across_alpha()}, wo, points);
    const Albedo<1> got = AnisotropicGgxAlbedo<1>(ggx).at(vector(wo));
    f1.add(got.f1, wanted.f1);
    schlick.add(got.schlick, wanted.schlick);
  }
  f1.expect(tables::kAnisotropicF1Error, "F = 1");
  schlick.expect(tables::kAnisotropicSchlickError, "Schlick");
}

TEST(TableErrors, AnisotropicMeans) {
  const Quadrature cosines = tables::graded(24), turns = tables::gauss_legendre(16);
  Errors f1, schlick;
  Spread roughnesses = spread(0, 2), strengths = spread(1, 2);
  for (int i = 0; i < 200; ++i) {
    const AnisotropicGgxAlbedo<1> albedo(AnisotropicGgx<1>(
        static_cast<float>(roughnesses()), static_cast<float>(strengths()), {0.6F, 0.8F}));
    double white = 0, edge = 0;
    for (std::size_t k = 0; k < cosines.at.size() * turns.at.size(); ++k) {
      const std::size_t row = k / turns.at.size(), column = k % turns.at.size();
      const double z = cosines.at[row], across = std::sqrt(1 - z * z);
      const double turn = turns.at[column] * 2 * std::numbers::pi;
      const Albedo<1> there =
          albedo.at(vector({.x = across * std::cos(turn), .y = across * std::sin(turn), .z = z}));
      const double weight = 2 * z * cosines.weights[row] * turns.weights[column];
      white += weight * there.f1;
      edge += weight * there.schlick;
    }
    f1.add(albedo.mean().f1, white);
    schlick.add(albedo.mean().schlick, edge);
  }
  f1.expect(tables::kAnisotropicMeanF1Error, "F = 1");
  schlick.expect(tables::kAnisotropicMeanSchlickError, "Schlick");
}

TEST(TableErrors, AreDocumented) {
  std::ifstream file(tests::source_folder() / "docs/derivations.md");
  const std::string text((std::istreambuf_iterator<char>(file)), {});
  const auto row = [&](const std::string& name, const tables::StatedError& error) {
    EXPECT_THAT(text, HasSubstr("| " + name + " | " + cells_text(error) + " |"));
  };
  row("GGX, F = 1", tables::kGgxF1Error);
  row("GGX, F = (1 - cos)^5", tables::kGgxSchlickError);
  row("cosine-weighted mean of GGX, F = 1", tables::kGgxMeanF1Error);
  row("cosine-weighted mean of GGX, F = (1 - cos)^5", tables::kGgxMeanSchlickError);
  row("sheen", tables::kSheenError);
  row("deficit under a clear coat, F = 1", tables::kDeficitF1Error);
  row("deficit under a clear coat, F = (1 - cos)^5", tables::kDeficitSchlickError);
  row("loss of refraction, from the thinner side", tables::kLossOutsideError);
  row("loss of refraction, from the denser side", tables::kLossWithinError);
  row("loss of refraction for other Fresnel terms, from the thinner side",
      tables::kAnyLossOutsideError);
  row("loss of refraction for other Fresnel terms, from the denser side",
      tables::kAnyLossWithinError);
  row("anisotropic GGX, F = 1", tables::kAnisotropicF1Error);
  row("anisotropic GGX, F = (1 - cos)^5", tables::kAnisotropicSchlickError);
  row("cosine-weighted mean of anisotropic GGX, F = 1", tables::kAnisotropicMeanF1Error);
  row("cosine-weighted mean of anisotropic GGX, F = (1 - cos)^5",
      tables::kAnisotropicMeanSchlickError);
}

}  // namespace
}  // namespace microtrace::bsdf
