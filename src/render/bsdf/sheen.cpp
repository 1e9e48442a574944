#include "render/bsdf/sheen.hpp"

#include "scene/exponential.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace microtrace::bsdf {
namespace {

constexpr std::size_t kSteps = 16;

/// [roughness][angle]: roughness from kLeastSheenRoughness to 1, cos(theta) from 0 to 1, in equal
/// steps. By the midpoint rule with 1500 x 400 directions.
constexpr std::array<std::array<float, kSteps>, kSteps> kAlbedo = {{
    {{0.867530F, 0.670793F, 0.454458F, 0.317731F, 0.223699F, 0.156716F, 0.108379F, 0.073486F,
      0.048556F, 0.031144F, 0.019140F, 0.011058F, 0.005831F, 0.002658F, 0.000918F, 0.000128F}},
    {{0.771792F, 0.643061F, 0.460672F, 0.340689F, 0.254407F, 0.189780F, 0.140454F, 0.102555F,
      0.073549F, 0.051749F, 0.035364F, 0.023138F, 0.014185F, 0.007842F, 0.003582F, 0.000966F}},
    {{0.713040F, 0.628021F, 0.468241F, 0.360332F, 0.280393F, 0.218464F, 0.169379F, 0.130052F,
      0.098553F, 0.073754F, 0.054067F, 0.038381F, 0.025954F, 0.016256F, 0.008888F, 0.003520F}},
    {{0.678266F, 0.623280F, 0.478756F, 0.379419F, 0.304313F, 0.244739F, 0.196247F, 0.156231F,
      0.123148F, 0.096286F, 0.074168F, 0.055752F, 0.040372F, 0.027583F, 0.017070F, 0.008589F}},
    {{0.660279F, 0.626869F, 0.492592F, 0.399211F, 0.327600F, 0.269832F, 0.221898F, 0.181487F,
      0.147308F, 0.118968F, 0.095042F, 0.074509F, 0.056730F, 0.041297F, 0.027940F, 0.016464F}},
    {{0.654740F, 0.637175F, 0.509583F, 0.420180F, 0.350944F, 0.294412F, 0.246840F, 0.206099F,
      0.171069F, 0.141602F, 0.116293F, 0.094113F, 0.074423F, 0.056827F, 0.041072F, 0.026982F}},
    {{0.658775F, 0.652793F, 0.529271F, 0.442335F, 0.374561F, 0.318741F, 0.271287F, 0.230178F,
      0.194405F, 0.164019F, 0.137611F, 0.114131F, 0.092931F, 0.073611F, 0.055923F, 0.039702F}},
    {{0.670248F, 0.672394F, 0.550993F, 0.465367F, 0.398330F, 0.342782F, 0.295212F, 0.253660F,
      0.217191F, 0.186011F, 0.158697F, 0.134175F, 0.111782F, 0.091113F, 0.071920F, 0.054047F}},
    {{0.687334F, 0.694633F, 0.573913F, 0.488737F, 0.421886F, 0.366268F, 0.318394F, 0.276332F,
      0.239196F, 0.207311F, 0.179236F, 0.153871F, 0.130540F, 0.108832F, 0.088503F, 0.069405F}},
    {{0.708224F, 0.718071F, 0.597030F, 0.511710F, 0.444670F, 0.388755F, 0.340461F, 0.297863F,
      0.260103F, 0.227599F, 0.198889F, 0.172849F, 0.148794F, 0.126308F, 0.105152F, 0.085190F}},
    {{0.730937F, 0.741139F, 0.619194F, 0.533399F, 0.465977F, 0.409664F, 0.360925F, 0.317826F,
      0.279526F, 0.246510F, 0.217297F, 0.190745F, 0.166159F, 0.143122F, 0.121400F, 0.100873F}},
    {{0.753180F, 0.762117F, 0.639114F, 0.552786F, 0.484983F, 0.428319F, 0.379217F, 0.335732F,
      0.297031F, 0.263651F, 0.234093F, 0.207201F, 0.182273F, 0.158895F, 0.136836F, 0.115995F}},
    {{0.772303F, 0.779146F, 0.655384F, 0.568758F, 0.500782F, 0.443971F, 0.394711F, 0.351047F,
      0.312154F, 0.278608F, 0.248901F, 0.221866F, 0.196799F, 0.173284F, 0.151100F, 0.130162F}},
    {{0.785349F, 0.790262F, 0.666520F, 0.580131F, 0.512413F, 0.455824F, 0.406740F, 0.363206F,
      0.324407F, 0.290957F, 0.261344F, 0.234397F, 0.209413F, 0.185977F, 0.163875F, 0.143038F}},
    {{0.789226F, 0.793470F, 0.671004F, 0.585691F, 0.518875F, 0.463047F, 0.414606F, 0.371614F,
      0.333277F, 0.300250F, 0.271029F, 0.244445F, 0.219796F, 0.196673F, 0.174868F, 0.154330F}},
    {{0.781027F, 0.786838F, 0.667342F, 0.584220F, 0.519158F, 0.464788F, 0.417582F, 0.375647F,
      0.338223F, 0.306015F, 0.277541F, 0.251641F, 0.227619F, 0.205071F, 0.183799F, 0.163765F}},
}};

/// The exponent of the paper's fit of the masking.
double fit(double x, double alpha) {
  const double t = (1 - alpha) * (1 - alpha);
  const auto mix = [t](double rough, double smooth) { return rough + t * (smooth - rough); };
  const double a = mix(21.5473, 25.3245), b = mix(3.82987, 3.32435), c = mix(0.19823, 0.16801),
               d = mix(-1.97760, -1.27393), e = mix(-4.32054, -4.85967);
  return a / (1 + b * power(x, c)) + d * x + e;
}

}  // namespace

SheenLobe::SheenLobe(float roughness) {
  const float r = std::clamp(roughness, kLeastSheenRoughness, 1.0F);
  alpha_ = double{r} * r;
  row_ = (r - kLeastSheenRoughness) / (1 - kLeastSheenRoughness) * (kSteps - 1);
}

double SheenLobe::lambda(double cosine) const {
  if (cosine < 0.5) return exponential(fit(cosine, alpha_));
  return exponential(2 * fit(0.5, alpha_) - fit(1 - cosine, alpha_));
}

float SheenLobe::reflectance(const Vec3& wo, const Vec3& wi, const Vec3& h) const {
  const double sine_square = double{h.x} * h.x + double{h.y} * h.y;
  const double d =
      (2 + 1 / alpha_) * power(sine_square, 0.5 / alpha_) * (0.5 * std::numbers::inv_pi);
  const double masking = 1 + lambda(wo.z) + lambda(wi.z);
  return static_cast<float>(d / (4 * masking * wo.z * wi.z));
}

float SheenLobe::albedo(float z) const {
  const auto place = [](float at) {
    const auto first = std::min(static_cast<std::size_t>(at), kSteps - 2);
    return std::pair(first, at - static_cast<float>(first));
  };
  const auto [row, down] = place(row_);
  const auto [column, right] = place(std::clamp(z, 0.0F, 1.0F) * (kSteps - 1));
  const auto in_row = [c = column, r = right](const std::array<float, kSteps>& values) {
    return values[c] + r * (values[c + 1] - values[c]);
  };
  const float upper = in_row(kAlbedo[row]), lower = in_row(kAlbedo[row + 1]);
  return upper + down * (lower - upper);
}

}  // namespace microtrace::bsdf
