/// Tests the positions of samples in pixels and on the lens against their pdfs, and the alpha of
/// pixels against the part of the pixel filter's weight that a surface covers.
#include "support/pi.hpp"
#include "support/pictures.hpp"
#include "support/shading/chi_square.hpp"

#include <microtrace/camera.hpp>
#include <microtrace/integrator.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

namespace microtrace {
namespace {

constexpr PixelFilter kFilters[] = {PixelFilter::box, PixelFilter::blackman_harris};

/// The fraction of the filter's weight below u in one dimension, u in pixels from the upper left
/// corner. For the Blackman-Harris window it is the integral of the window's cosine series.
double weight_below(PixelFilter filter, double u) {
  if (filter == PixelFilter::box) return std::clamp(u, 0.0, 1.0);
  const double t = std::clamp((u - 0.5) / 3, -0.5, 0.5), x = 2 * kPi * t;
  return 0.5 + t +
         (0.48829 * std::sin(x) + 0.14128 / 2 * std::sin(2 * x) + 0.01168 / 3 * std::sin(3 * x)) /
             (2 * kPi * 0.35875);
}

/// The fraction of the filter's weight where n.x u + n.y v < s.
double weight_below(PixelFilter filter, const DVec2& n, double s) {
  if (n.y == 0) return weight_below(filter, s / n.x);
  constexpr int kSteps = 3000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double from = -1 + 3.0 * i / kSteps, to = -1 + 3.0 * (i + 1) / kSteps;
    const double below = weight_below(filter, (s - n.x * (from + to) / 2) / n.y);
    sum += (weight_below(filter, to) - weight_below(filter, from)) * below;
  }
  return sum;
}

/// Returns a camera that sees the rectangle from (0, 0) to `size` of the plane z = 0. Its pixels
/// have side 1, and y points up.
Camera camera_of(ImageSize size) {
  return OrthographicCamera{.pose = {.position = {size.width / 2.0, size.height / 2.0, 1}},
                            .height = static_cast<double>(size.height)};
}

/// Returns arbitrary colors, and records rays and colors. Only one thread may render.
class Recorder final : public Integrator {
 public:
  struct Seen {
    SampleId id;
    DVec3 origin;
    float color;
  };

  void trace(const World& /*world*/, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const float color = std::abs(rays[i].o.x - std::floor(rays[i].o.y)) + 0.25F;
      seen_.push_back({.id = ids[i], .origin = DVec3(rays[i].o), .color = color});
      samples[i] = {.color = Vec3(color), .alpha = 1};
    }
  }
  [[nodiscard]] bool is_random() const override { return true; }
  [[nodiscard]] const std::vector<Seen>& seen() const { return seen_; }

 private:
  mutable std::vector<Seen> seen_;
};

// The samples of different pixels are independent, so counting one sample of each pixel gives
// independent samples of the filter's density.
TEST(PixelSamples, HaveTheDensityOfTheFilter) {
  constexpr ImageSize kPicture{.width = 640, .height = 512};
  constexpr int kSide = 15;
  for (const PixelFilter filter : kFilters) {
    const double low = filter == PixelFilter::box ? 0 : -1, width = 1 - 2 * low;
    const Recorder recorder;
    (void)render(Scene{}, camera_of(kPicture), kPicture,
                 {.threads = 1, .integrator = &recorder, .samples = 2, .filter = filter});
    for (const std::uint32_t index : {0U, 1U}) {
      std::vector<double> counts(kSide * kSide), expected;
      for (const auto& [id, origin, color] : recorder.seen()) {
        if (id.index != index) continue;
        const double u = origin.x - id.x, v = kPicture.height - origin.y - id.y;
        const auto cell = [&](double at) {
          return std::clamp(int(std::floor((at - low) / width * kSide)), 0, kSide - 1);
        };
        ++counts[std::size_t(cell(v) * kSide + cell(u))];
      }
      for (int row = 0; row < kSide; ++row) {
        for (int column = 0; column < kSide; ++column) {
          const auto part = [&](int cell) {
            return weight_below(filter, low + width * (cell + 1) / kSide) -
                   weight_below(filter, low + width * cell / kSide);
          };
          expected.push_back(part(row) * part(column) * kPicture.width * kPicture.height);
        }
      }
      EXPECT_LT(chi_square_excess(counts, expected), 5) << index;
    }
  }
}

TEST(PixelSamples, HaveEqualWeights) {
  constexpr ImageSize kPicture{.width = 19, .height = 11};
  for (const PixelFilter filter : kFilters) {
    const Recorder recorder;
    const Film film =
        render(Scene{}, camera_of(kPicture), kPicture,
               {.threads = 1, .integrator = &recorder, .samples = 7, .filter = filter});
    std::vector<double> means(std::size_t{kPicture.width} * kPicture.height);
    for (const auto& [id, origin, color] : recorder.seen())
      means[id.y * kPicture.width + id.x] += double{color} / 7;
    for (std::uint32_t y = 0; y < kPicture.height; ++y) {
      for (std::uint32_t x = 0; x < kPicture.width; ++x)
        EXPECT_NEAR(film.row(y)[x].y, means[y * kPicture.width + x], 1e-5);
    }
  }
}

// Positions on the lens are uniform over its disk, and independent of positions in the pixel.
TEST(LensSamples, AreUniformOverTheDisk) {
  constexpr ImageSize kPicture{.width = 320, .height = 256};
  constexpr int kRings = 8, kSectors = 12;
  const PerspectiveCamera camera{.vertical_fov = 0.6, .focus = 4, .lens_radius = 0.25};
  const Recorder recorder;
  (void)render(Scene{}, camera, kPicture, {.threads = 1, .integrator = &recorder, .samples = 1});
  std::vector<double> counts(kRings * kSectors);
  for (const Recorder::Seen& seen : recorder.seen()) {
    const DVec2 p = DVec2(seen.origin) / camera.lens_radius;
    EXPECT_NEAR(seen.origin.z, 0, 1e-6);
    EXPECT_LT(glm::dot(p, p), 1 + 1e-5);
    const double turn = std::atan2(p.y, p.x) / (2 * kPi) + 0.5;
    const auto ring = std::min(int(glm::dot(p, p) * kRings), kRings - 1);
    ++counts[std::size_t(ring * kSectors + std::min(int(turn * kSectors), kSectors - 1))];
  }
  const double all = double{kPicture.width} * kPicture.height;
  const std::vector<double> expected(counts.size(), all / (kRings * kSectors));
  EXPECT_LT(chi_square_excess(counts, expected), 5);
}

constexpr ImageSize kSquare{.width = 96, .height = 96};

/// Renders with alpha, by the path integrator or flat.
Film with_alpha(const Scene& scene, PixelFilter filter, bool is_flat) {
  const PathIntegrator path({.max_depth = 1});
  return render(scene, camera_of(kSquare), kSquare,
                {.threads = 1,
                 .integrator = is_flat ? nullptr : static_cast<const Integrator*>(&path),
                 .samples = 64,
                 .filter = filter,
                 .transparent = true});
}

/// Compares the mean alpha of the pixels with n.x x + n.y y = k, for each k, with expected(k), and
/// the mean of all of these pixels. Independent samples, each 0 or 1, would have the standard
/// deviation below. The samples of a pixel are better distributed.
template <class Expected>
void expect_alpha(Film film, const std::array<int, 2>& n, bool is_flat, const Expected& expected) {
  const int last = n[0] * int(kSquare.width - 1) + n[1] * int(kSquare.height - 1);
  std::vector<double> sums(std::size_t(last) + 1), pixels(sums.size());
  for (int y = 2; y < int(kSquare.height) - 2; ++y) {
    for (int x = 2; x < int(kSquare.width) - 2; ++x) {
      const auto k = std::size_t(n[0] * x + n[1] * y);
      sums[k] += double{film.alpha_at(std::uint32_t(x), std::uint32_t(y))};
      ++pixels[k];
    }
  }
  double difference = 0, variance = 0;
  for (std::size_t k = 0; k < sums.size(); ++k) {
    if (pixels[k] < 16) continue;
    const double mean = std::clamp(expected(double(k)), 0.0, 1.0), all = 64 * pixels[k];
    // Rounding may move two samples across an edge.
    const double bound = is_flat ? 2.0 / 64 : 5 * std::sqrt(mean * (1 - mean) / all) + 2 / all;
    EXPECT_NEAR(sums[k] / pixels[k], mean, bound) << k << ' ' << is_flat;
    difference += 64 * (sums[k] - pixels[k] * mean);
    variance += mean * (1 - mean) * all;
  }
  EXPECT_LE(std::abs(difference), 5 * std::sqrt(variance) + 100) << is_flat;
}

/// A surface with the four corners' alphas, over the whole picture and beyond.
Object veil(const std::array<float, 4>& alphas, std::uint32_t material, float z = 0) {
  const auto side = float(kSquare.width);
  Mesh mesh = parallelogram({-side, -side, z}, {3 * side, 0, 0}, {0, 3 * side, 0});
  for (const float alpha : alphas) mesh.colors.push_back(Vec4(1, 1, 1, alpha));
  return {.name = "veil", .shape = std::move(mesh), .material = material};
}

TEST(Coverage, EdgeCoversThePartOfTheFilterOnItsSide) {
  const auto side = float(kSquare.width);
  for (const auto& n : {std::array{1, 0}, std::array{1, 1}, std::array{1, 2}}) {
    for (const float offset : {0.15F, 0.5F, 0.85F}) {
      // The half plane where n.x x + n.y y < limit, with y measured down from the top.
      const float limit = 60 + offset;
      const Vec3 down(0, -1, 0), right(1, 0, 0);
      const Vec3 at = Vec3(0, side, 0) + right * (limit / float(n[0]));
      const Vec3 along = right * float(n[1]) - down * float(n[0]);
      const Vec3 inside = -right * float(n[0]) - down * float(n[1]);
      Scene scene;
      scene.materials = {{}};
      scene.objects.push_back({.name = "half plane",
                               .shape = Mesh{.positions = {at - 400.0F * along, at + 400.0F * along,
                                                           at - 400.0F * along + 400.0F * inside,
                                                           at + 400.0F * along + 400.0F * inside},
                                             .triangles = {{{0, 1, 2}}, {{1, 3, 2}}}},
                               .material = 0});
      scene.environment = Environment{.content = Vec3(0)};
      for (const PixelFilter filter : kFilters) {
        for (const bool is_flat : {false, true}) {
          expect_alpha(with_alpha(scene, filter, is_flat), n, is_flat, [&](double k) {
            return weight_below(filter, DVec2(n[0], n[1]), double{limit} - k);
          });
        }
      }
    }
  }
}

// A mask's alpha increases from left to right by 1 in 3 * 96 pixels.
TEST(Coverage, MaskCoversWhereAlphaReachesTheCutoff) {
  Scene scene;
  scene.environment = Environment{.content = Vec3(0)};
  for (const float cutoff : {0.4F, 0.501F, 0.59375F}) {
    scene.materials = {{.alpha_mode = AlphaMode::mask, .alpha_cutoff = cutoff}};
    scene.objects = {veil({0, 1, 1, 0}, 0)};
    const double edge = double{cutoff} * 3 * kSquare.width - kSquare.width;
    for (const PixelFilter filter : kFilters) {
      for (const bool is_flat : {false, true}) {
        expect_alpha(with_alpha(scene, filter, is_flat), {1, 0}, is_flat,
                     [&](double k) { return 1 - weight_below(filter, edge - k); });
      }
    }
  }
}

// The alpha of a blended surface is the mean over the filter, and layers multiply their
// transparency.
TEST(Coverage, BlendedSurfacesHaveTheirMeanAlpha) {
  Scene scene;
  scene.environment = Environment{.content = Vec3(0)};
  scene.materials = {{.alpha_mode = AlphaMode::blend},
                     {.base_color = {1, 1, 1, 0.35F}, .alpha_mode = AlphaMode::blend}};
  for (const bool has_two : {false, true}) {
    scene.objects = {veil({0, 1, 1, 0}, 0)};
    if (has_two) scene.objects.push_back(veil({1, 1, 1, 1}, 1, -1));
    for (const PixelFilter filter : kFilters) {
      for (const bool is_flat : {false, true}) {
        expect_alpha(with_alpha(scene, filter, is_flat), {1, 0}, is_flat, [&](double k) {
          const double alpha = (kSquare.width + k + 0.5) / (3 * kSquare.width);
          return has_two ? 1 - (1 - alpha) * (1 - 0.35) : alpha;
        });
      }
    }
  }
}

}  // namespace
}  // namespace microtrace
