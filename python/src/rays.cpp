/// Binds ray queries in bulk.

#include "accel/resolve/exact_hits.hpp"
#include "ray_arrays.hpp"

#include <algorithm>
#include <memory>
#include <nanobind/stl/unique_ptr.h>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::python {
namespace {

void intersect(const Prepared& self, const AnyArray& array, const nb::object& t_min,
               const nb::object& t_max, const nb::dict& outputs, unsigned threads) {
  const Bvh& bvh = self.scene.bvh();
  const DVec3 origin = self.scene.scene().origin;
  const Rays source(array, t_min, t_max, origin);
  const Outputs to(outputs);
  for_each_block(source.size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> rays;
    source.get(first, last, rays);
    std::vector<std::optional<Hit>> hits(rays.size());
    bvh.intersect(rays, hits);
    to.fill(self.scene, first, rays, hits);
  });
}

void occluded(const Prepared& self, const AnyArray& array, const nb::object& t_min,
              const nb::object& t_max, const nb::ndarray<bool, nb::c_contig>& result,
              unsigned threads) {
  const Rays source(array, t_min, t_max, self.scene.scene().origin);
  bool* to = result.data();
  for_each_block(source.size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> rays;
    source.get(first, last, rays);
    self.scene.bvh().occluded(rays, std::span(to + first, rays.size()));
  });
}

/// Returns the explanation of a single ray as JSON text.
std::string explain_ray(const Prepared& self, const AnyArray& array, const nb::object& t_min,
                        const nb::object& t_max, std::size_t max_hits, std::size_t max_misses) {
  std::vector<Ray> rays;
  Rays(array, t_min, t_max, self.scene.scene().origin).get(0, 1, rays);
  std::string json;
  run_interruptible([&](const Caller& caller) {
    json = explanation_json(explain_in_scene(
        self.scene, rays.front(), {.max_hits = max_hits, .max_misses = max_misses, .cancel = [&] {
                                     return caller.is_canceled();
                                   }}));
  });
  return json;
}

/// All hits of rays. The rays are processed in pieces, so that they are not copied all at once.
struct AllHits {
  std::vector<std::uint64_t> offsets{0};
  std::vector<Hit> hits;
};

/// Options for a query that Ctrl-C can stop.
QueryOptions cancelable(unsigned threads, const Caller& caller) {
  return {.threads = threads, .progress = [&caller](double) { return !caller.is_canceled(); }};
}

/// Calls f(rays, first, options) for consecutive pieces of the rays, in scene coordinates.
template <class F>
void for_each_piece(const Rays& source, unsigned threads, const F& f) {
  constexpr std::size_t kPiece = 1 << 20;
  run_interruptible([&](const Caller& caller) {
    std::vector<Ray> rays;
    for (std::size_t first = 0; first < source.size(); first += kPiece) {
      source.get(first, std::min(first + kPiece, source.size()), rays);
      f(rays, first, cancelable(threads, caller));
    }
  });
}

std::unique_ptr<AllHits> intersect_all(const Prepared& self, const AnyArray& array,
                                       const nb::object& t_min, const nb::object& t_max,
                                       unsigned threads) {
  const Rays source(array, t_min, t_max, self.scene.scene().origin);
  auto result = std::make_unique<AllHits>();
  for_each_piece(source, threads, [&](const auto& rays, std::size_t, const QueryOptions& options) {
    const RayHits found = intersect_all(self.scene.bvh(), rays, options);
    const std::uint64_t before = result->hits.size();
    for (std::size_t i = 1; i < found.offsets.size(); ++i)
      result->offsets.push_back(before + found.offsets[i]);
    result->hits.insert(result->hits.end(), found.hits.begin(), found.hits.end());
  });
  return result;
}

/// Sets ties[k] for the hits of one ray to true if hit k has exactly the same t as the hit before.
void find_ties(const Primitives& primitives, const Ray& ray,
               std::span<const std::optional<Hit>> hits, bool* ties) {
  const ExactHits exactly(primitives, ray);
  for (std::size_t k = 0; k < hits.size(); ++k) {
    ties[k] =
        k > 0 && hits[k]->t == hits[k - 1]->t && exactly.order(hits[k - 1]->id, hits[k]->id) == 0;
  }
}

/// Takes the arguments and the result of intersect_all(). Fills `outputs`, the offsets, the ray of
/// each hit and, if `ties` is not empty, what find_ties() finds.
void fill_all(const Prepared& self, const AllHits& all, const AnyArray& array,
              const nb::object& t_min, const nb::object& t_max, const nb::dict& outputs,
              const nb::ndarray<std::int64_t, nb::c_contig>& offsets,
              const nb::ndarray<std::int64_t, nb::c_contig>& owners,
              const nb::ndarray<bool, nb::c_contig>& ties, unsigned threads) {
  const Rays source(array, t_min, t_max, self.scene.scene().origin);
  const Outputs to(outputs);
  std::copy(all.offsets.begin(), all.offsets.end(), offsets.data());
  std::int64_t* owner = owners.data();
  for_each_block(source.size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> rays, rays_of_hits;
    source.get(first, last, rays);
    const std::size_t begin = all.offsets[first];
    std::vector<std::optional<Hit>> hits(
        all.hits.begin() + static_cast<std::ptrdiff_t>(begin),
        all.hits.begin() + static_cast<std::ptrdiff_t>(all.offsets[last]));
    rays_of_hits.reserve(hits.size());
    for (std::size_t i = first; i < last; ++i) {
      for (std::size_t k = all.offsets[i]; k < all.offsets[i + 1]; ++k) {
        rays_of_hits.push_back(rays[i - first]);
        owner[k] = static_cast<std::int64_t>(i);
      }
      if (ties.size() == 0) continue;
      const std::size_t count = all.offsets[i + 1] - all.offsets[i];
      find_ties(self.scene.bvh().primitives(), rays[i - first],
                std::span(hits).subspan(all.offsets[i] - begin, count),
                ties.data() + all.offsets[i]);
    }
    to.fill(self.scene, begin, rays_of_hits, hits);
  });
}

/// Sets facing[i] to the sign of the normal of a triangle, which is a face of the first object,
/// along the direction of ray i; 0 for triangles that are parallel to the ray.
void find_facing(const Prepared& self, const AnyArray& array,
                 const nb::ndarray<const std::int32_t, nb::c_contig>& faces,
                 const nb::ndarray<std::int8_t, nb::c_contig>& facing, unsigned threads) {
  const Rays source(array, nb::none(), nb::none(), self.scene.scene().origin);
  const Primitives& primitives = self.scene.bvh().primitives();
  const std::int32_t* face = faces.data();
  std::int8_t* to = facing.data();
  for_each_block(source.size(), threads, [&](std::size_t first, std::size_t last) {
    std::vector<Ray> rays;
    source.get(first, last, rays);
    for (std::size_t i = first; i < last; ++i) {
      const Vec3 d = rays[i - first].d;
      const Triangle triangle = *primitives.triangle(static_cast<PrimitiveId>(face[i]));
      to[i] =
          static_cast<std::int8_t>(int{shows_front(triangle, -d)} - int{shows_front(triangle, d)});
    }
  });
}

void count_crossings(const Prepared& self, const AnyArray& array, const nb::object& t_min,
                     const nb::object& t_max,
                     const nb::ndarray<std::uint32_t, nb::c_contig>& counts, unsigned threads) {
  const Rays source(array, t_min, t_max, self.scene.scene().origin);
  std::uint32_t* to = counts.data();
  for_each_piece(
      source, threads, [&](const auto& rays, std::size_t first, const QueryOptions& options) {
        count_crossings(self.scene.bvh(), rays, std::span(to + first, rays.size()), options);
      });
}

}  // namespace

void bind_rays(nb::module_& module) {
  nb::object prepared = module.attr("Prepared");
  auto& type = static_cast<nb::class_<Prepared>&>(prepared);
  type.def("intersect", &intersect, nb::arg("rays"), nb::arg("t_min").none(),
           nb::arg("t_max").none(), nb::arg("outputs"), nb::arg("threads"), WholeCall());
  type.def("explain", &explain_ray, nb::arg("ray"), nb::arg("t_min").none(),
           nb::arg("t_max").none(), nb::arg("max_hits"), nb::arg("max_misses"), WholeCall());
  type.def("occluded", &occluded, nb::arg("rays"), nb::arg("t_min").none(), nb::arg("t_max").none(),
           nb::arg("result"), nb::arg("threads"), WholeCall());
  nb::class_<AllHits>(module, "AllHits").def("__len__", [](const AllHits& all) {
    return all.hits.size();
  });
  type.def("intersect_all", &intersect_all, nb::arg("rays"), nb::arg("t_min").none(),
           nb::arg("t_max").none(), nb::arg("threads"), WholeCall());
  type.def("fill_all", &fill_all, nb::arg("hits"), nb::arg("rays"), nb::arg("t_min").none(),
           nb::arg("t_max").none(), nb::arg("outputs"), nb::arg("offsets"), nb::arg("owners"),
           nb::arg("ties"), nb::arg("threads"), WholeCall());
  type.def("find_facing", &find_facing, nb::arg("rays"), nb::arg("faces"), nb::arg("facing"),
           nb::arg("threads"), WholeCall());
  type.def("count_crossings", &count_crossings, nb::arg("rays"), nb::arg("t_min").none(),
           nb::arg("t_max").none(), nb::arg("counts"), nb::arg("threads"), WholeCall());
}

}  // namespace microtrace::python
