#pragma once
/// Rays and hits as arrays of NumPy.

#include "common.hpp"
#include "prepared.hpp"

#include <limits>
#include <optional>
#include <vector>

namespace microtrace::python {

using FloatRow = nb::ndarray<const float, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Rays as they come from Python.
class Rays {
 public:
  /// rays: (n, 6) float32 or float64; the ends of the intervals: (n) float32, or None.
  Rays(const AnyArray& rays, const nb::object& t_min, const nb::object& t_max, const DVec3& origin)
      : rays_(rays), is_double_(rays.dtype() == nb::dtype<double>()), origin_(origin) {
    if (!t_min.is_none()) t_min_ = nb::cast<FloatRow>(t_min);
    if (!t_max.is_none()) t_max_ = nb::cast<FloatRow>(t_max);
  }

  [[nodiscard]] std::size_t size() const { return rays_.shape(0); }

  /// In scene coordinates.
  void get(std::size_t first, std::size_t last, std::vector<Ray>& to) const {
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

/// The arrays to fill; null: not asked for.
struct Outputs {
  explicit Outputs(const nb::dict& d)
      : t(output<float>(d, "t")),
        object(output<std::int32_t>(d, "object")),
        primitive(output<std::int32_t>(d, "primitive")),
        position(output<float>(d, "position")),
        normal(output<float>(d, "normal")),
        face_normal(output<float>(d, "face_normal")),
        barycentrics(output<float>(d, "barycentrics")),
        uv(output<float>(d, "uv")),
        front(output<bool>(d, "front")) {}

  [[nodiscard]] bool has_surface() const {
    return position || normal || face_normal || barycentrics || uv || front;
  }

  float* t;
  std::int32_t *object, *primitive;
  float *position, *normal, *face_normal, *barycentrics, *uv;
  bool* front;
};

inline void put(float* to, std::size_t i, const DVec3& v) {
  if (to == nullptr) return;
  for (glm::length_t k = 0; k < 3; ++k)
    to[3 * i + static_cast<std::size_t>(k)] = static_cast<float>(v[k]);
}

/// Fills the arrays at place i for a hit or a miss of a ray in scene coordinates.
inline void fill(const Outputs& to, std::size_t i, const Primitives& primitives, const Ray& ray,
                 const std::optional<Hit>& hit) {
  if (to.t) to.t[i] = hit ? hit->t : std::numeric_limits<float>::infinity();
  if (to.object || to.primitive) {
    const std::size_t object = hit ? primitives.object_index(hit->id) : 0;
    if (to.object) to.object[i] = hit ? static_cast<std::int32_t>(object) : -1;
    if (to.primitive)
      to.primitive[i] =
          hit ? static_cast<std::int32_t>(hit->id - primitives.first_id_of(object)) : -1;
  }
  if (!to.has_surface()) return;
  const SurfaceInteraction at =
      hit ? interact(primitives, ray, *hit)
          : SurfaceInteraction{.n = DVec3(0), .ns = DVec3(0), .front = false};
  put(to.position, i, hit ? at.p + primitives.scene().origin : DVec3(0));
  put(to.normal, i, at.ns);
  put(to.face_normal, i, at.n);
  put(to.barycentrics, i, at.triangle ? at.triangle->barycentrics : DVec3(0));
  if (to.uv) {
    const DVec2 uv = at.uv(0).value_or(DVec2(0));
    to.uv[2 * i] = static_cast<float>(uv.x);
    to.uv[2 * i + 1] = static_cast<float>(uv.y);
  }
  if (to.front) to.front[i] = at.front;
}

}  // namespace microtrace::python
