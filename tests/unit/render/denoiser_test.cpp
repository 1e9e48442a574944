#include <microtrace/denoise.hpp>
#include <microtrace/error.hpp>
#include <microtrace/path.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <glm/common.hpp>
#include <gmock/gmock.h>

namespace microtrace {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr ImageSize kSmall{.width = 16, .height = 12};

/// A lamp above a floor that fills the lower half of the picture.
Scene lamp_and_floor() {
  Scene scene;
  scene.background = Vec3(0.25F);
  scene.environment = Environment{.content = Vec3(0.5F)};
  scene.materials = {{.base_color = Vec4(0.5F, 0.5F, 0.5F, 1)}, {.emissive = Vec3(5)}};
  scene.objects = {{.name = "floor", .shape = Plane{{0, -1, 0}, {0, 1, 0}}, .material = 0},
                   {.name = "lamp", .shape = Sphere{{0, 1, 0}, 0.5F}, .material = 1}};
  return scene;
}

class DenoiserTest : public testing::Test {
 protected:
  void SetUp() override { ::setenv("MICROTRACE_OIDN_PATH", FAKE_OIDN, 1); }
  void TearDown() override {
    ::unsetenv("MICROTRACE_OIDN_PATH");
    ::unsetenv("FAKE_OIDN");
  }

  static Film drawn(RenderOptions options, bool denoises = true, double lens_radius = 0) {
    const PreparedScene scene(lamp_and_floor());
    const PathIntegrator path;
    if (options.integrator == nullptr) options.integrator = &path;
    options.samples = 4;
    const Camera camera =
        PerspectiveCamera{.pose = {.position = {0, 0, 4}}, .focus = 1, .lens_radius = lens_radius};
    return denoises ? Denoiser().render(scene, camera, kSmall, options)
                    : render(scene, camera, kSmall, options);
  }

  /// The error of denoising a picture.
  static std::optional<Error> failure(RenderOptions options = {}) {
    try {
      (void)drawn(std::move(options));
    } catch (const Error& error) {
      return error;
    }
    return std::nullopt;
  }
};

std::vector<std::string> channel_names(const Film& film) {
  std::vector<std::string> names;
  for (const Channel& channel : film.channels) names.push_back(channel.name);
  return names;
}

Vec3 channel(const Film& film, std::size_t first, std::size_t pixel) {
  Vec3 value;
  for (glm::length_t c = 0; c < 3; ++c) {
    const Channel& from = film.channels.at(first + static_cast<std::size_t>(c));
    value[c] = std::get<std::vector<float>>(from.values).at(pixel);
  }
  return value;
}

TEST_F(DenoiserTest, FiltersOnlyScatteredLight) {
  Film noisy = drawn({.sampled_aovs = {SampledAov::emission, SampledAov::denoise_normal,
                                       SampledAov::denoise_emission}},
                     false);
  Film denoised = drawn({.sampled_aovs = {SampledAov::noisy}});
  EXPECT_EQ(denoised.denoiser, "Open Image Denoise 2.0.7");
  EXPECT_THAT(channel_names(denoised), ElementsAre("noisy.R", "noisy.G", "noisy.B"));
  std::size_t changed = 0, background = 0;
  for (std::uint32_t y = 0; y < kSmall.height; ++y) {
    for (std::uint32_t x = 0; x < kSmall.width; ++x) {
      const std::size_t i = std::size_t{y} * kSmall.width + x;
      const Vec3 before = noisy.at(x, y), after = denoised.at(x, y);
      EXPECT_EQ(channel(denoised, 0, i), before);
      if (channel(noisy, 3, i) == Vec3(0)) {
        EXPECT_EQ(after, before + (channel(noisy, 6, i) - channel(noisy, 0, i)));
        EXPECT_EQ(before, Vec3(0.25F));
        ++background;
        continue;
      }
      const auto rest = [&](std::uint32_t column) {
        const std::size_t at = std::size_t{y} * kSmall.width + column;
        return noisy.at(column, y) - channel(noisy, 0, at);
      };
      const Vec3 filtered = x + 1 < kSmall.width ? 0.5F * (rest(x) + rest(x + 1)) : rest(x);
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(after[c], channel(noisy, 6, i)[c] + filtered[c], 1e-6);
      if (after != before) ++changed;
    }
  }
  EXPECT_GT(changed, 40U);
  EXPECT_GT(background, 40U);
}

/// Expects that all light up to `white` and all other scattered light were filtered, except far
/// from where the background changes. `noisy` has the emission from few and from many samples.
void expect_filtered(Film& noisy, Film& denoised, float white) {
  const Vec3 background(0.25F), added(0x1p-6F);
  std::size_t filtered = 0, kept = 0;
  const auto beyond_white = [&](std::size_t first, std::uint32_t x, std::uint32_t y) {
    const Vec3 emission = channel(noisy, first, std::size_t{y} * kSmall.width + x);
    return glm::max(emission - Vec3(white), Vec3(0));
  };
  for (std::uint32_t y = 0; y < kSmall.height; ++y) {
    for (std::uint32_t x = 2; x + 2 < kSmall.width; ++x) {
      const Vec3 after = denoised.at(x, y);
      if (after == background) {
        for (std::uint32_t column = x - 2; column <= x + 2; ++column)
          EXPECT_EQ(noisy.at(column, y), background);
        ++kept;
        continue;
      }
      const auto rest = [&](std::uint32_t column) {
        return noisy.at(column, y) - beyond_white(0, column, y);
      };
      const Vec3 wanted = beyond_white(3, x, y) + 0.5F * (rest(x) + rest(x + 1)) + added;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(after[c], wanted[c], 1e-6);
      ++filtered;
    }
  }
  EXPECT_GT(filtered, 60U);
  EXPECT_GT(kept, 5U);
}

const std::vector<SampledAov> kEmissions = {SampledAov::emission, SampledAov::denoise_emission};

TEST_F(DenoiserTest, FiltersFeaturesAndAllLightOfALens) {
  ::setenv("FAKE_OIDN", "noisy", 1);
  Film noisy = drawn({.sampled_aovs = kEmissions}, false, 0.2), denoised = drawn({}, true, 0.2);
  expect_filtered(noisy, denoised, 1e9F);
}

TEST_F(DenoiserTest, FiltersShadowsOnAGround) {
  ::setenv("FAKE_OIDN", "noisy", 1);
  const PathIntegrator path({.ground = Ground{.height = -2}});
  Film noisy = drawn({.integrator = &path, .sampled_aovs = kEmissions}, false);
  Film denoised = drawn({.integrator = &path});
  expect_filtered(noisy, denoised, 1);
}

TEST_F(DenoiserTest, KeepsAlpha) {
  Film noisy = drawn({.transparent = true}, false), denoised = drawn({.transparent = true});
  ASSERT_TRUE(denoised.has_alpha());
  for (std::uint32_t y = 0; y < kSmall.height; ++y) {
    for (std::uint32_t x = 0; x < kSmall.width; ++x) {
      EXPECT_EQ(denoised.alpha_at(x, y), noisy.alpha_at(x, y));
      if (noisy.alpha_at(x, y) == 0) {
        EXPECT_EQ(denoised.at(x, y), Vec3(0));
      }
    }
  }
}

/// True if all pixels at most two pixels away have the same alpha.
bool has_uniform_alpha(Film& film, std::uint32_t x, std::uint32_t y) {
  for (std::uint32_t v = y - 2; v <= y + 2; ++v) {
    for (std::uint32_t u = x - 2; u <= x + 2; ++u) {
      if (film.alpha_at(u, v) != film.alpha_at(x, y)) return false;
    }
  }
  return true;
}

// Alpha that varies is filtered: with a lens everywhere, above a ground only where no object is.
TEST_F(DenoiserTest, FiltersNoisyAlpha) {
  ::setenv("FAKE_OIDN", "noisy", 1);
  const PathIntegrator path({.ground = Ground{.height = -2}});
  for (const double lens_radius : {0.0, 0.02}) {
    RenderOptions options{.integrator = &path, .transparent = true};
    Film denoised = drawn(options, true, lens_radius);
    options.sampled_aovs = {SampledAov::denoise_normal};
    Film noisy = drawn(options, false, lens_radius);
    std::size_t filtered = 0, kept = 0;
    for (std::uint32_t y = 2; y + 2 < kSmall.height; ++y) {
      for (std::uint32_t x = 2; x + 2 < kSmall.width; ++x) {
        const bool is_empty = channel(noisy, 0, std::size_t{y} * kSmall.width + x) == Vec3(0);
        const bool is_kept = (lens_radius == 0 && !is_empty) || has_uniform_alpha(noisy, x, y);
        const float here = noisy.alpha_at(x, y), beside = noisy.alpha_at(x + 1, y);
        const float wanted = is_kept ? here : std::min((here + beside) / 2 + 0x1p-6F, 1.0F);
        EXPECT_EQ(denoised.alpha_at(x, y), wanted) << x << ' ' << y;
        ++(is_kept ? kept : filtered);
      }
    }
    EXPECT_GT(filtered, 10U);
    EXPECT_GT(kept, 5U);
  }
}

TEST_F(DenoiserTest, CountsMemory) {
  MemoryBudget budget(std::uint64_t{1} << 30U);
  (void)drawn({.memory = &budget});
  EXPECT_GT(budget.peak(), 17'000'000U);
  MemoryBudget small(std::uint64_t{16} << 20U);
  EXPECT_EQ(failure({.memory = &small})->kind(), ErrorKind::limit);
}

TEST_F(DenoiserTest, ProgressCancels) {
  int calls = 0;
  const auto error = failure({.threads = 1, .progress = [&](double share) {
                                calls += share == 1 ? 1 : 0;
                                return calls < 2;
                              }});
  ASSERT_TRUE(error);
  EXPECT_EQ(error->kind(), ErrorKind::canceled);
  EXPECT_THROW((void)drawn({.threads = 1,
                            .progress =
                                [calls = 0](double share) mutable {
                                  if (share == 1 && ++calls == 2) throw std::string("mine");
                                  return true;
                                }}),
               std::string);
}

TEST_F(DenoiserTest, ReportsFailuresOfTheLibrary) {
  ::setenv("FAKE_OIDN", "memory", 1);
  EXPECT_EQ(failure()->kind(), ErrorKind::limit);
  ::setenv("FAKE_OIDN", "broken", 1);
  EXPECT_EQ(failure()->kind(), ErrorKind::internal);
  EXPECT_THAT(failure()->what(), HasSubstr("made up for a test"));
  ::setenv("FAKE_OIDN", "processor", 1);
  EXPECT_EQ(failure()->kind(), ErrorKind::unsupported);
  EXPECT_THAT(failure()->what(), HasSubstr("unsupported hardware"));
}

TEST_F(DenoiserTest, NeedsPathTracingAndFeatures) {
  const FlatIntegrator flat;
  EXPECT_EQ(failure({.integrator = &flat})->kind(), ErrorKind::usage);
  Film film(kSmall);
  EXPECT_THROW(Denoiser().denoise(film), Error);
}

TEST_F(DenoiserTest, ErrorsNameTheRemedy) {
  const auto complaint = [](const std::string& path) {
    ::setenv("MICROTRACE_OIDN_PATH", path.c_str(), 1);
    try {
      const Denoiser denoiser;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::unsupported);
      EXPECT_THAT(error.what(), HasSubstr("pip install"));
      EXPECT_THAT(error.what(), HasSubstr("MICROTRACE_OIDN_PATH="));
      return std::string(error.what());
    }
    return std::string();
  };
  const std::filesystem::path folder = testing::TempDir();
  EXPECT_THAT(complaint("/no/such/folder"), HasSubstr("/no/such/folder"));
  EXPECT_THAT(complaint(folder.string()), HasSubstr("libOpenImageDenoise.so.2"));
  const std::filesystem::path text = folder / "no_library.so";
  std::ofstream(text) << "text";
  EXPECT_THAT(complaint(text.string()), HasSubstr("not a shared library"));
  Dl_info other{};
  ASSERT_NE(::dladdr(reinterpret_cast<const void*>(&std::fopen), &other), 0);
  EXPECT_THAT(complaint(other.dli_fname),
              HasSubstr(std::string(other.dli_fname) + " lacks oidnNewDevice"));
}

}  // namespace
}  // namespace microtrace
