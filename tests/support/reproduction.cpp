#include "support/reproduction.hpp"

#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include <glm/common.hpp>

namespace microtrace::adversarial {
namespace {

std::string hexadecimal(const Vec3& v) {
  std::ostringstream out;
  out << std::hexfloat << '(' << v.x << ", " << v.y << ", " << v.z << ')';
  return std::move(out).str();
}

/// Writes JSON whose decimal numbers are read back as the same float32 numbers.
class Writer {
 public:
  Writer() { out_ << std::setprecision(std::numeric_limits<float>::max_digits10); }

  Writer& operator()(float x) {
    out_ << x;
    return *this;
  }

  Writer& operator()(const char* key, float x) {
    out_ << ", \"" << key << "\": " << x;
    return *this;
  }

  Writer& operator()(const char* key, const Vec3& v) {
    out_ << ", \"" << key << "\": [" << v.x << ", " << v.y << ", " << v.z << ']';
    return *this;
  }

  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

std::string object(const Sphere& s) {
  return R"("type": "sphere")" + Writer()("center", s.center)("radius", s.radius).text();
}

std::string object(const Plane& p) {
  return R"("type": "plane")" + Writer()("point", p.point)("normal", p.normal).text();
}

std::string object(const Disc& d) {
  return R"("type": "disc")" +
         Writer()("center", d.center)("normal", d.normal)("radius", d.radius).text();
}

std::string object(const Triangle& t) {
  return R"("type": "triangle")" + Writer()("a", t.a)("b", t.b)("c", t.c).text();
}

std::string object(const Quadric& q) {
  return R"("type": "quadric", "coefficients": {"a": )" +
         Writer()(q.a)("b", q.b)("c", q.c)("d", q.d)("e", q.e)("f", q.f)("g", q.g)("h", q.h)(
             "i", q.i)("j", q.j)
             .text() +
         '}';
}

/// Returns the coordinate axis that has the largest angle to v.
Vec3 across(const Vec3& v) {
  const Vec3 size = glm::abs(v);
  if (size.x <= size.y && size.x <= size.z) return {1, 0, 0};
  return size.y <= size.z ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
}

}  // namespace

std::string reproduction(const Ray& ray, const FirstHitShape& shape) {
  std::ostringstream out;
  out << std::hexfloat << "o " << hexadecimal(ray.o) << "  d " << hexadecimal(ray.d) << "  t_min "
      << ray.t_min << "  t_max " << ray.t_max << '\n';
  const std::string camera =
      R"("type": "orthographic", "height": 1)" +
      Writer()("position", ray.o)("direction", ray.d)("up", across(ray.d)).text();
  out << R"({"version": 1, "image": {"width": 1, "height": 1}, "cameras": [{)" << camera
      << R"(}], "objects": [{)" << std::visit([](const auto& s) { return object(s); }, shape)
      << "}]}\n";
  return std::move(out).str();
}

}  // namespace microtrace::adversarial
