#pragma once
/// Converts rays and hits from and to NumPy arrays.

#include "base/system/float_environment.hpp"
#include "common.hpp"
#include "prepared.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace microtrace::python {

using FloatRow = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Rays in arrays from Python.
class Rays {
 public:
  /// `rays` is (n, 6) float32 or float64. `t_min` and `t_max` are (n) float32 or None.
  Rays(const AnyArray& rays, const nb::object& t_min, const nb::object& t_max, const DVec3& origin)
      : rays_(rays), is_double_(rays.dtype() == nb::dtype<double>()), origin_(origin) {
    if (!t_min.is_none()) t_min_ = nb::cast<FloatRow>(t_min);
    if (!t_max.is_none()) t_max_ = nb::cast<FloatRow>(t_max);
  }

  [[nodiscard]] std::size_t size() const { return rays_.shape(0); }

  /// Sets `to` to the rays [first, last) in scene coordinates.
  void get(std::size_t first, std::size_t last, std::vector<Ray>& to) const {
    const FloatEnvironment environment;
    to.resize(last - first);
    if (is_double_)
      gather<double>(first, to);
    else
      gather<float>(first, to);
  }

 private:
  template <class Number>
  void gather(std::size_t first, std::vector<Ray>& to) const {
    const std::int64_t row = rays_.stride(0), column = rays_.stride(1);
    const auto* data =
        static_cast<const Number*>(rays_.data()) + static_cast<std::int64_t>(first) * row;
    for (std::size_t i = 0; i < to.size(); ++i, data += row) {
      const DVec3 o(data[0], data[column], data[2 * column]);
      Ray& ray = to[i];
      ray = {.o = Vec3(o - origin_),
             .d = Vec3(DVec3(data[3 * column], data[4 * column], data[5 * column]))};
      if (t_min_.is_valid()) ray.t_min = t_min_.data()[first + i];
      if (t_max_.is_valid()) ray.t_max = t_max_.data()[first + i];
    }
  }

  AnyArray rays_;
  bool is_double_;
  DVec3 origin_;
  FloatRow t_min_, t_max_;
};

template <class T>
T* output(const nb::dict& outputs, const char* name) {
  if (!outputs.contains(name)) return nullptr;
  return nb::cast<nb::ndarray<T, nb::c_contig, nb::device::cpu>>(outputs[name]).data();
}

/// The arrays to fill; null for arrays that are not requested.
struct Outputs {
  explicit Outputs(const nb::dict& d)
      : t(output<float>(d, "t")),
        // Misses get -1, whose bits equal those of SurfaceBuffers::kNone.
        object(reinterpret_cast<std::uint32_t*>(output<std::int32_t>(d, "object"))),
        primitive(reinterpret_cast<std::uint32_t*>(output<std::int32_t>(d, "primitive"))),
        position(output<double>(d, "position")),
        normal(output<float>(d, "normal")),
        face_normal(output<float>(d, "face_normal")),
        barycentrics(output<float>(d, "barycentrics")),
        uv(output<float>(d, "uv")),
        front(output<bool>(d, "front")) {}

  /// Fills the arrays, starting at index `first`, for rays in scene coordinates.
  void fill(const PreparedScene& scene, std::size_t first, std::span<const Ray> rays,
            std::span<const std::optional<Hit>> hits) const {
    if (t != nullptr)
      for (std::size_t i = 0; i < hits.size(); ++i)
        t[first + i] = hits[i] ? hits[i]->t : std::numeric_limits<float>::infinity();
    if (position || normal || face_normal || barycentrics || uv || front) {
      scene.surfaces_in_scene(rays, hits,
                              {.p = at<3>(position, first),
                               .n = at<3>(face_normal, first),
                               .ns = at<3>(normal, first),
                               .barycentrics = at<3>(barycentrics, first),
                               .uv = at<2>(uv, first),
                               .front = at<1>(front, first),
                               .object = at<1>(object, first),
                               .primitive = at<1>(primitive, first)});
    } else if (object || primitive) {
      fill_ids(scene.bvh().primitives(), first, hits);
    }
  }

 private:
  template <std::ptrdiff_t width, class T>
  static OutputArray<T> at(T* data, std::size_t first) {
    if (data == nullptr) return {};
    return {.data = data + width * static_cast<std::ptrdiff_t>(first), .stride = width};
  }

  void fill_ids(const Primitives& primitives, std::size_t first,
                std::span<const std::optional<Hit>> hits) const {
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const std::optional<Hit>& hit = hits[i];
      const std::size_t owner = hit ? primitives.object_index(hit->id) : 0;
      if (object)
        object[first + i] = hit ? static_cast<std::uint32_t>(owner) : SurfaceBuffers::kNone;
      if (primitive)
        primitive[first + i] =
            hit ? hit->id - primitives.first_id_of(owner) : SurfaceBuffers::kNone;
    }
  }

  float* t;
  std::uint32_t *object, *primitive;
  double* position;
  float *normal, *face_normal, *barycentrics, *uv;
  bool* front;
};

}  // namespace microtrace::python
