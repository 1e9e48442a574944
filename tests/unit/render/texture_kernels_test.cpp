// Compares the texture kernels of every instruction set of this machine bit by bit with lookups of
// single texels.
#include "render/bsdf/base_surface.hpp"
#include "render/lanes/dispatch.hpp"
#include "render/lanes/lane_access.hpp"
#include "render/textures/texture_map.hpp"
#include "support/lane_tests.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <memory>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

template <typename Number>
std::vector<Number> random_samples(LaneRandom& random, std::size_t count) {
  std::vector<Number> samples(count);
  for (Number& sample : samples) sample = static_cast<Number>(random.bits());
  return samples;
}

/// An image of random texels with a random sampler.
class RandomTexture {
 public:
  explicit RandomTexture(LaneRandom& random)
      : image_{.width = size(random), .height = size(random), .channels = 1 + random.bits() % 4} {
    const std::size_t count = std::size_t{image_.width} * image_.height * image_.channels;
    if (random.bits() % 2 != 0)
      image_.samples = random_samples<std::uint16_t>(random, count);
    else
      image_.samples = random_samples<std::uint8_t>(random, count);
    sampler_ = {.wrap_s = Wrap{static_cast<int>(random.bits() % 3)},
                .wrap_t = Wrap{static_cast<int>(random.bits() % 3)},
                .magnification = Filter{static_cast<int>(random.bits() % 2)},
                .minification = Filter{static_cast<int>(random.bits() % 2)},
                .mip = MipFilter{static_cast<int>(random.bits() % 3)}};
    const auto encoding = random.bits() % 2 != 0 ? ColorEncoding::srgb : ColorEncoding::linear;
    map_ = std::make_unique<TextureMap>(image_, sampler_, encoding);
  }

  [[nodiscard]] const TextureMap& map() const { return *map_; }
  [[nodiscard]] const Sampler& sampler() const { return sampler_; }
  [[nodiscard]] double smaller_size() const { return std::min(image_.width, image_.height); }

 private:
  static std::uint32_t size(LaneRandom& random) {
    return random.number() < 0.2F ? 1 : 1 + random.bits() % 70;
  }

  Image image_;
  Sampler sampler_;
  std::unique_ptr<TextureMap> map_;
};

float random_coordinate(LaneRandom& random) {
  const float kind = random.number();
  if (kind < 0.1F) return static_cast<float>(random.bits() % 9) - 4;  // at the seam
  if (kind < 0.15F) return random.signed_unit() * 0x1p30F;
  if (kind < 0.17F) return std::numeric_limits<float>::quiet_NaN();
  return 3 * random.signed_unit();
}

TEST(TextureMap, SamplesAreLookupsInFloat32) {
  LaneRandom random(1);
  for (int round = 0; round < kRounds; ++round) {
    const RandomTexture texture(random);
    const Sampler& sampler = texture.sampler();
    const Vec2 uv(3 * random.signed_unit(), 3 * random.signed_unit());
    const DVec4 expected = texture.map().look_up(DVec2(uv), {});
    const Vec4 sample = texture.map().sample(uv, 0);
    // Near the edge of a texel, rounding may select another one.
    if (sampler.magnification == Filter::nearest) continue;
    for (glm::length_t i = 0; i < 4; ++i) EXPECT_NEAR(sample[i], expected[i], 1e-4) << round;
  }
}

TEST(TextureMap, WideSamplesAreTexelsOfTheLevel) {
  LaneRandom random(2);
  int compared = 0;
  for (int round = 0; round < kRounds; ++round) {
    const RandomTexture texture(random);
    const Sampler& sampler = texture.sampler();
    if (sampler.mip != MipFilter::nearest || sampler.minification != Filter::linear) continue;
    ++compared;
    // A footprint whose width is a power of two has a level of its own.
    const Vec2 uv(random.number(), random.number());
    const double width = (1 << random.bits() % 5) * 1.0;
    const TexelGrid& grid = texture.map().grid();
    const double larger = std::max(grid.x.size, grid.y.size);
    const DVec2 step(width / grid.x.size, width / grid.y.size);
    if (width == 1) continue;
    const DVec4 expected = texture.map().look_up(DVec2(uv), {.dx = {step.x, 0}, .dy = {0, step.y}});
    const Vec4 sample = texture.map().sample(uv, static_cast<float>(1.0001 * width / larger));
    for (glm::length_t i = 0; i < 4; ++i) EXPECT_NEAR(sample[i], expected[i], 1e-4) << round;
  }
  EXPECT_GT(compared, kRounds / 10);
}

class TextureKernelsTest : public testing::TestWithParam<const ShadingKernels*> {};

/// A use of a texture by a surface.
struct Use {
  RandomTexture texture;
  TexelLayout layout;

  explicit Use(LaneRandom& random) : texture(random) {
    layout.grid = texture.map().grid();
    for (auto& column : layout.grid_from_uv)
      for (float& x : column) x = random.signed_unit();
    layout.width_scale = random.number() < 0.3F ? 0 : 2 * random.number();
  }
  [[nodiscard]] Vec4 at(const HitLanes& hits, const LaneFloats& widths, int lane) const {
    const auto& m = layout.grid_from_uv;
    const float u = hits.first_uv[0][lane], v = hits.first_uv[1][lane];
    return texture.map().sample(
        {m[0][0] * u + m[1][0] * v + m[2][0], m[0][1] * u + m[1][1] * v + m[2][1]},
        widths[lane] * hits.first_uv_scale[lane] * layout.width_scale);
  }
};

TEST_P(TextureKernelsTest, TexelsHaveTheBitsOfSingleLookups) {
  LaneRandom random(3);
  for (int round = 0; round < kRounds; ++round) {
    std::deque<Use> uses;
    TexturedSurface surface{.metallic = random.number(), .roughness = random.number()};
    for (int value = 0; value < TexturedSurface::kValues; ++value) {
      if (random.number() < 0.3F) continue;
      const Use& use = uses.emplace_back(random);
      surface.layouts[surface.layout_count] = use.layout;
      surface.reads[surface.read_count++] = {
          .texels = use.texture.map().texels(), .layout = surface.layout_count++, .value = value};
    }
    const float kind = random.number();
    surface.normal_scale = random.number();
    for (float& x : surface.base_color) x = 2 * random.number();
    const auto lit = static_cast<glm::length_t>(random.bits() % 3);
    if (random.bits() % 2 != 0) surface.emission[lit] = 1;
    HitLanes hits{};
    TexturedLanes textured{};
    LaneFloats widths;
    for (int i = 0; i < kShadingLanes; ++i) {
      for (auto& uv : hits.first_uv) uv[i] = random_coordinate(random);
      widths[i] = std::exp2(20 * random.signed_unit());
      hits.first_uv_scale[i] = std::exp2(3 * random.signed_unit());
      for (auto& channel : textured.color) channel[i] = random.number();
      textured.least_alpha[i] = kind < 0.3F   ? -std::numeric_limits<float>::infinity()
                                : kind < 0.4F ? 2
                                              : random.number();
    }
    SurfaceLanes surfaces{};
    NormalMapLanes normals{};
    const Lanes lanes = random.bits() & kAllLanes<kShadingLanes>;
    GetParam()->load_textured(surface, lanes, hits, widths, textured, surfaces, normals);
    for (int i = 0; i < kShadingLanes; ++i) {
      if ((lanes >> i & 1U) == 0) {
        EXPECT_EQ(surfaces.roughness[i], 0);
        EXPECT_EQ(normals.scale[i], 0);
        EXPECT_EQ(textured.values[0][0][i], 0);
        EXPECT_EQ((textured.covers | textured.opaque) >> i & 1U, 0);
        continue;
      }
      Vec4 values[TexturedSurface::kValues];
      std::fill_n(values, TexturedSurface::kValues, Vec4(1));
      for (int k = 0; k < surface.read_count; ++k)
        values[surface.reads[k].value] = uses[static_cast<std::size_t>(k)].at(hits, widths, i);
      const auto value = [&](TexelValue which) { return values[static_cast<int>(which)]; };
      Vec4 factor;
      for (int k = 0; k < 4; ++k) factor[k] = surface.base_color[k] * textured.color[k][i];
      const Vec4 rough = value(TexelValue::metallic_roughness);
      const bsdf::BaseSurface<1> base(Vec3(factor * value(TexelValue::base_color)), surface,
                                      rough.y, rough.z);
      for (int k = 0; k < 3; ++k) {
        expect_bits(surfaces.base_color[k][i], base.color[k], "base color");
        expect_bits(normals.texel[k][i], value(TexelValue::normal)[k], "normal");
      }
      expect_bits(surfaces.metallic[i], base.metallic, "metallic");
      expect_bits(surfaces.roughness[i], base.roughness, "roughness");
      expect_bits(normals.scale[i], surface.normal_scale, "normal scale");
      const bool is_dark = surface.emission[lit] == 0 || value(TexelValue::emission)[lit] == 0;
      const bool covers = factor.w * value(TexelValue::alpha).w >= textured.least_alpha[i];
      EXPECT_EQ(textured.covers >> i & 1U, covers ? 1U : 0U) << round << ", " << i;
      EXPECT_EQ(textured.opaque >> i & 1U, is_dark && covers ? 1U : 0U) << round << ", " << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Isa, TextureKernelsTest, testing::ValuesIn(kShadingKernels.available()),
                         [](const auto& set) { return std::string(set.param->name); });

}  // namespace
}  // namespace microtrace
