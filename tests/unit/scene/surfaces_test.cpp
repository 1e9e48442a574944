#include "support/cases/adversarial_scenes.hpp"

#include <microtrace/prepared_scene.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <vector>

#include <gtest/gtest.h>

namespace microtrace {
namespace {

/// An output array with guards between and around the values. take() returns a value and replaces
/// it by a guard.
template <class T>
class Values {
 public:
  Values(std::size_t count, std::size_t components, std::ptrdiff_t stride,
         std::ptrdiff_t component_stride)
      : stride_(stride), component_stride_(component_stride) {
    const auto least = [](std::ptrdiff_t step, std::size_t n) {
      return n > 0 && step < 0 ? step * static_cast<std::ptrdiff_t>(n - 1) : 0;
    };
    first_ = 3 - least(stride, count) - least(component_stride, components);
    const auto size = first_ - least(-stride, count) - least(-component_stride, components) + 4;
    values_ = std::make_unique<T[]>(static_cast<std::size_t>(size));
    size_ = static_cast<std::size_t>(size);
    std::fill_n(values_.get(), size_, kGuard);
  }

  [[nodiscard]] OutputArray<T> array() {
    return {.data = &values_[static_cast<std::size_t>(first_)],
            .stride = stride_,
            .component_stride = component_stride_};
  }
  [[nodiscard]] T take(std::size_t i, std::size_t c = 0) {
    const auto at = first_ + static_cast<std::ptrdiff_t>(i) * stride_ +
                    static_cast<std::ptrdiff_t>(c) * component_stride_;
    return std::exchange(values_[static_cast<std::size_t>(at)], kGuard);
  }
  [[nodiscard]] bool has_only_guards() const {
    return std::all_of(values_.get(), values_.get() + size_, [](T v) { return v == kGuard; });
  }

 private:
  static constexpr T kGuard = std::is_same_v<T, bool> ? T(1) : T(7654321);
  std::ptrdiff_t stride_, component_stride_, first_ = 0;
  std::unique_ptr<T[]> values_;
  std::size_t size_ = 0;
};

/// Returns true if both values have the same bits or both are NaN.
template <class T>
bool is_same(T a, T b) {
  if constexpr (std::is_floating_point_v<T>)
    return (std::isnan(a) && std::isnan(b)) || (a == b && std::signbit(a) == std::signbit(b));
  else
    return a == b;
}

template <class T, class V>
void expect_vector(Values<T>& values, std::size_t i, const V& expected, const char* what) {
  for (glm::length_t c = 0; c < expected.length(); ++c) {
    const T got = values.take(i, static_cast<std::size_t>(c)), want = static_cast<T>(expected[c]);
    ASSERT_TRUE(is_same(got, want))
        << what << "[" << c << "] of ray " << i << ": " << got << " instead of " << want;
  }
}

struct Layout {
  bool is_planar, is_backward;
};

void compare(const PreparedScene& scene, const std::vector<Ray>& rays, const Layout& layout) {
  std::vector<std::optional<Hit>> hits(rays.size());
  scene.intersect(rays, hits);
  const auto count = static_cast<std::ptrdiff_t>(rays.size());
  const auto make = [&]<class T>(T, std::size_t components) {
    const auto n = static_cast<std::ptrdiff_t>(components);
    const std::ptrdiff_t sign = layout.is_backward ? -1 : 1;
    return layout.is_planar ? Values<T>(rays.size(), components, sign, sign * (count + 1))
                            : Values<T>(rays.size(), components, sign * (n + 1), 1);
  };
  auto p = make(double{}, 3);
  auto n = make(float{}, 3), ns = make(float{}, 3), weights = make(float{}, 3);
  auto uv = make(float{}, 2);
  auto front = make(bool{}, 1);
  auto object = make(std::uint32_t{}, 1), primitive = make(std::uint32_t{}, 1);
  scene.surfaces(rays, hits,
                 {.p = p.array(),
                  .n = n.array(),
                  .ns = ns.array(),
                  .barycentrics = weights.array(),
                  .uv = uv.array(),
                  .front = front.array(),
                  .object = object.array(),
                  .primitive = primitive.array()});
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto at = hits[i] ? std::optional(scene.surface(rays[i], *hits[i])) : std::nullopt;
    expect_vector(p, i, at ? at->p : DVec3(0), "p");
    expect_vector(n, i, at ? at->n : DVec3(0), "n");
    expect_vector(ns, i, at ? at->ns : DVec3(0), "ns");
    expect_vector(weights, i, at && at->triangle ? at->triangle->barycentrics : DVec3(0),
                  "barycentrics");
    expect_vector(uv, i, at ? at->uv(0).value_or(DVec2(0)) : DVec2(0), "uv");
    ASSERT_EQ(front.take(i), at && at->front);
    ASSERT_EQ(object.take(i), at ? at->object : SurfaceBuffers::kNone);
    ASSERT_EQ(primitive.take(i), at ? at->primitive : SurfaceBuffers::kNone);
  }
  EXPECT_TRUE(p.has_only_guards() && n.has_only_guards() && ns.has_only_guards() &&
              weights.has_only_guards() && uv.has_only_guards() && front.has_only_guards() &&
              object.has_only_guards() && primitive.has_only_guards());
}

/// Adds normals, some of them zero, and texture coordinates to some of the meshes.
void add_attributes(adversarial::Random& random, Scene& scene) {
  for (Object& object : scene.objects) {
    auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh == nullptr) continue;
    const auto number = [&] { return static_cast<float>(random.between(-8, 8)) / 4; };
    const bool has_normals = !random.one_in(4), has_uv = !random.one_in(4);
    if (has_uv) mesh->uv_sets.emplace_back();
    for (std::size_t i = 0; i < mesh->positions.size(); ++i) {
      if (has_normals)
        mesh->normals.push_back(random.one_in(8) ? Vec3(0) : Vec3(number(), number(), number()));
      if (has_uv) mesh->uv_sets[0].push_back({number(), number()});
    }
  }
}

class Surfaces : public testing::TestWithParam<adversarial::SceneKind> {};
INSTANTIATE_TEST_SUITE_P(Kinds, Surfaces, testing::ValuesIn(adversarial::kSceneKinds),
                         [](const auto& kind) { return adversarial::name(kind.param); });

TEST_P(Surfaces, AreThoseOfSingleHits) {
  adversarial::Random random(static_cast<unsigned>(GetParam()) + 1);
  for (int round = 0; round < 12; ++round) {
    Scene made = adversarial::random_scene(random, GetParam());
    add_attributes(random, made);
    std::vector<Ray> rays = adversarial::unrelated_rays(random, made, 333);
    if (round % 3 == 0) made.origin = {1000.5, 0.1, -3e5};
    const PreparedScene scene(made, {.threads = 1});
    compare(scene, rays, {.is_planar = round % 2 == 0, .is_backward = round % 4 > 1});
  }
}

TEST(Surfaces, StoreOnlyWhatIsAskedFor) {
  Scene made;
  made.objects.push_back({.name = "sphere", .shape = Sphere{}});
  const PreparedScene scene(made, {.threads = 1});
  const std::vector<Ray> rays(100, Ray{.o = {0, 0, 3}});
  std::vector<std::optional<Hit>> hits(rays.size());
  scene.intersect(rays, hits);
  scene.surfaces(rays, hits, {});
  std::vector<float> ns(300, 5);
  scene.surfaces(rays, hits, {.ns = {.data = ns.data(), .stride = 3}});
  for (std::size_t i = 0; i < ns.size(); ++i) EXPECT_EQ(ns[i], i % 3 == 2 ? 1 : 0);
  scene.surfaces({}, {}, {.ns = {.data = ns.data()}});
}

}  // namespace
}  // namespace microtrace
