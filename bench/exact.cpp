// Measures one exact decision for each shape, which is the cost of a ray for which the filters are
// unsure.

#include "exact/first_hit.hpp"
#include "exact/grid.hpp"

#include <benchmark/benchmark.h>

namespace {

using namespace microtrace;

const Triangle kTriangle{{-1.1F, -0.9F, 0.1F}, {1.3F, -0.8F, 0.2F}, {0.1F, 2.3F, -0.3F}};
const Ray kRay{.o = {0.3F, -0.2F, 5.1F}, .d = {-0.011F, 0.17F, -0.98F}};

template <class S>
void first_hit(benchmark::State& state, const S& shape) {
  for (auto _ : state) benchmark::DoNotOptimize(exact::first_hit(shape, kRay));
}

template <int Limbs>
void grid_hit(benchmark::State& state) {
  for (auto _ : state) benchmark::DoNotOptimize(exact::GridHit<Limbs>(kTriangle, kRay).found());
}

template <int Limbs>
void grid_order(benchmark::State& state) {
  const exact::GridHit<Limbs> hit(kTriangle, kRay);
  for (auto _ : state) benchmark::DoNotOptimize(hit.order(kTriangle));
}

void order(benchmark::State& state) {
  const auto a = *exact::first_hit(Sphere{{0.1F, 0.2F, 0.3F}, 2}, kRay);
  const auto b = *exact::first_hit(Sphere{{0.2F, 0.1F, 0.4F}, 2.1F}, kRay);
  for (auto _ : state) benchmark::DoNotOptimize(a < b);
}

}  // namespace

BENCHMARK(grid_hit<2>);
BENCHMARK(grid_hit<3>);
BENCHMARK(grid_order<2>);
BENCHMARK(grid_order<3>);
BENCHMARK_CAPTURE(first_hit, triangle, kTriangle);
BENCHMARK_CAPTURE(first_hit, sphere, (Sphere{{0.1F, 0.2F, 0.3F}, 2}));
BENCHMARK_CAPTURE(first_hit, plane, (Plane{{0.1F, 0.2F, 0.3F}, {0.1F, 0.3F, 0.9F}}));
BENCHMARK_CAPTURE(first_hit, disc, (Disc{{0.1F, 0.2F, 0.3F}, {0.1F, 0.3F, 0.9F}, 3}));
BENCHMARK_CAPTURE(first_hit, quadric,
                  (Quadric{.a = 1.1F, .b = 0.9F, .c = 1.3F, .d = 0.1F, .j = -3.7F}));
BENCHMARK(order);
