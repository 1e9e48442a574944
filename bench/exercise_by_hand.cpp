#include "exercise_by_hand.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

namespace by_hand {
namespace {

constexpr float kEpsilon = 1e-4F;

struct Vec {
  float x, y, z;
};
Vec operator+(Vec a, Vec b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
Vec operator-(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Vec operator*(Vec a, float s) {
  return {a.x * s, a.y * s, a.z * s};
}
float dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
Vec normalized(Vec a) {
  return a * (1 / std::sqrt(dot(a, a)));
}
Vec vec(const float (&v)[3]) {
  return {v[0], v[1], v[2]};
}

struct Ray {
  Vec o, d;
  float t = std::numeric_limits<float>::infinity();
};

class Primitive {
 public:
  explicit Primitive(Vec shown) : color(shown) {}
  virtual ~Primitive() = default;
  /// Shortens the ray and returns true if it hits before ray.t.
  virtual bool intersect(Ray& ray) const = 0;

  Vec color;
};

bool shorten(Ray& ray, float t) {
  if (!(t > kEpsilon && t < ray.t)) return false;
  ray.t = t;
  return true;
}

class Sphere final : public Primitive {
 public:
  Sphere(Vec center, float radius, Vec shown)
      : Primitive(shown), center_(center), radius_(radius) {}
  bool intersect(Ray& ray) const override {
    const Vec m = ray.o - center_;
    const float b = dot(m, ray.d), discriminant = b * b - dot(m, m) + radius_ * radius_;
    if (discriminant < 0) return false;
    const float root = std::sqrt(discriminant);
    return shorten(ray, -b - root) || shorten(ray, -b + root);
  }

 private:
  Vec center_;
  float radius_;
};

class Plane final : public Primitive {
 public:
  Plane(Vec point, Vec normal, Vec shown) : Primitive(shown), point_(point), normal_(normal) {}
  bool intersect(Ray& ray) const override {
    return shorten(ray, dot(point_ - ray.o, normal_) / dot(ray.d, normal_));
  }

 private:
  Vec point_, normal_;
};

// T. Moeller and B. Trumbore, "Fast, minimum storage ray/triangle intersection", 1997.
class Triangle final : public Primitive {
 public:
  Triangle(Vec a, Vec b, Vec c, Vec shown) : Primitive(shown), a_(a), e1_(b - a), e2_(c - a) {}
  bool intersect(Ray& ray) const override {
    const Vec p = cross(ray.d, e2_), s = ray.o - a_;
    const float inverse = 1 / dot(e1_, p), u = dot(s, p) * inverse;
    if (u < 0 || u > 1) return false;
    const Vec q = cross(s, e1_);
    const float v = dot(ray.d, q) * inverse;
    if (v < 0 || u + v > 1) return false;
    return shorten(ray, dot(e2_, q) * inverse);
  }

 private:
  Vec a_, e1_, e2_;
};

std::vector<std::unique_ptr<Primitive>> make_scene() {
  std::vector<std::unique_ptr<Primitive>> scene;
  const auto add = [&](auto primitive) {
    scene.push_back(std::make_unique<decltype(primitive)>(std::move(primitive)));
  };
  add(Sphere({-2, 1.7F, 0}, 2, {1, 0, 0}));
  add(Sphere({1, -1, 1}, 2.2F, {0, 1, 0}));
  add(Sphere({3, 0.8F, -2}, 2, {0, 0, 1}));
  add(Plane({0, -1, 0}, {0, 1, 0}, {1, 1, 0}));
  add(Triangle({-2, 3.7F, 0}, {1, 2, 1}, {3, 2.8F, -2}, {0, 1, 1}));
  add(Triangle({3, 2, 3}, {3, 2, -3}, {-3, 2, -3}, {1, 1, 1}));
  return scene;
}

}  // namespace

std::vector<std::uint8_t> render(const Camera& camera, int width, int height) {
  const std::vector<std::unique_ptr<Primitive>> scene = make_scene();
  const Vec forward = normalized(vec(camera.direction));
  const Vec right = normalized(cross(forward, vec(camera.up))), up = cross(right, forward);
  const float half = std::tan(camera.vertical_fov * 3.14159265F / 360);
  const float half_width = half * static_cast<float>(width) / static_cast<float>(height);
  std::vector<Vec> film;
  film.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const float across =
          ((static_cast<float>(x) + 0.5F) / static_cast<float>(width) * 2 - 1) * half_width;
      const float above =
          (1 - (static_cast<float>(y) + 0.5F) / static_cast<float>(height) * 2) * half;
      Ray ray{vec(camera.position), normalized(forward + right * across + up * above)};
      Vec color{0, 0, 0};
      for (const auto& primitive : scene)
        if (primitive->intersect(ray)) color = primitive->color;
      film.push_back(color);
    }
  }
  std::vector<std::uint8_t> bytes;
  bytes.reserve(3 * film.size());
  for (const Vec& color : film)
    for (const float v : {color.x, color.y, color.z})
      bytes.push_back(static_cast<std::uint8_t>(v * 255 + 0.5F));
  return bytes;
}

}  // namespace by_hand
