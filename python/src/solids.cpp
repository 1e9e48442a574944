/// Binds the queries of points: inside or outside of meshes, and nearest points.

#include "common.hpp"
#include "prepared.hpp"

#include <memory>
#include <nanobind/stl/optional.h>
#include <optional>
#include <vector>

namespace microtrace::python {
namespace {

using Points = nb::ndarray<const double, nb::ndim<2>, nb::c_contig, nb::device::cpu>;

template <class T>
using Output = nb::ndarray<T, nb::c_contig, nb::device::cpu>;

std::span<const DVec3> span_of(const Points& points) {
  return {reinterpret_cast<const DVec3*>(points.data()), points.shape(0)};
}

template <class F>
void query(unsigned threads, const F& f) {
  run_interruptible([&](const Caller& caller) {
    f(QueryOptions{.threads = threads,
                   .progress = [&caller](double) { return !caller.is_canceled(); }});
  });
}

/// A Solid with its scene, which provides the indices of objects.
struct SolidOf {
  Solid solid;
  PreparedScene scene;
};

void locate(const SolidOf& self, const Points& points, const Output<std::int8_t>& sides,
            unsigned threads) {
  std::vector<Location> locations(points.shape(0));
  query(threads, [&](const QueryOptions& options) {
    self.solid.locate(span_of(points), locations, options);
  });
  std::int8_t* to = sides.data();
  for (const Location location : locations)
    *to++ = static_cast<std::int8_t>(location == Location::inside     ? 1
                                     : location == Location::boundary ? 0
                                                                      : -1);
}

void nearest(const SolidOf& self, const Points& points, const Output<double>& position,
             const Output<double>& distance, const Output<std::int32_t>& object,
             const Output<std::int32_t>& primitive, const Output<double>& barycentrics,
             unsigned threads) {
  std::vector<std::optional<NearestPoint>> found(points.shape(0));
  query(threads, [&](const QueryOptions& options) {
    self.solid.nearest_points(span_of(points), found, options);
  });
  const Primitives& primitives = self.scene.bvh().primitives();
  for (std::size_t i = 0; i < found.size(); ++i) {
    const NearestPoint& at =
        found[i].value_or(NearestPoint{.distance = std::numeric_limits<double>::infinity(),
                                       .p = DVec3(std::numeric_limits<double>::quiet_NaN()),
                                       .barycentrics = DVec3(0)});
    const std::size_t owner = found[i] ? primitives.object_index(at.id) : 0;
    distance.data()[i] = at.distance;
    object.data()[i] = found[i] ? static_cast<std::int32_t>(owner) : -1;
    primitive.data()[i] =
        found[i] ? static_cast<std::int32_t>(at.id - primitives.first_id_of(owner)) : -1;
    for (glm::length_t k = 0; k < 3; ++k) {
      const std::size_t place = 3 * i + static_cast<std::size_t>(k);
      position.data()[place] = at.p[k];
      barycentrics.data()[place] = at.barycentrics[k];
    }
  }
}

/// The ends of open edges, (n, 2, 3). The array keeps the solid, which owns them.
nb::object open_edges(const nb::object& self) {
  const auto& solid = nb::cast<const SolidOf&>(self).solid;
  const std::span<const OpenEdge> edges = result_unlocked([&] { return solid.open_edges(); });
  const double* data = edges.empty() ? nullptr : &edges.front().a.x;
  return nb::cast(nb::ndarray<nb::numpy, const double>(data, {edges.size(), 2, 3}, self,
                                                       {sizeof(OpenEdge) / sizeof(double), 3, 1}));
}

}  // namespace

void bind_solids(nb::module_& module) {
  nb::class_<SolidOf>(module, "Solid")
      .def(
          "__init__",
          [](SolidOf* self, const Prepared& prepared, std::optional<std::int64_t> object) {
            if (object && *object < 0)
              throw Error(ErrorKind::usage, "object", "must not be negative");
            new (self) SolidOf{Solid(prepared.scene, object), prepared.scene};
          },
          nb::arg("scene"), nb::arg("object").none(), WholeCall())
      .def(
          "is_closed",
          [](const SolidOf& self) {
            return result_unlocked([&] { return self.solid.is_closed(); });
          },
          WholeCall())
      .def("open_edges", &open_edges, WholeCall())
      .def("locate", &locate, WholeCall())
      .def("nearest", &nearest, WholeCall());
}

}  // namespace microtrace::python
