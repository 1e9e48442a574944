#include "io/scene_json/shape.hpp"

#include <array>
#include <utility>

namespace microtrace::io {
namespace {

Sphere read_sphere(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "center", "radius"});
  return {.center = json.member("center").vector32(), .radius = json.member("radius").float32()};
}

Plane read_plane(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "point", "normal"});
  return {.point = json.member("point").vector32(), .normal = json.member("normal").vector32()};
}

Disc read_disc(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "center", "normal", "radius"});
  return {.center = json.member("center").vector32(),
          .normal = json.member("normal").vector32(),
          .radius = json.member("radius").float32()};
}

Triangle read_triangle(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "a", "b", "c"});
  return {.a = json.member("a").vector32(),
          .b = json.member("b").vector32(),
          .c = json.member("c").vector32()};
}

Quadric read_quadric(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "coefficients"});
  const JsonReader coefficients = json.member("coefficients");
  coefficients.require_object({"a", "b", "c", "d", "e", "f", "g", "h", "i", "j"});
  Quadric q;
  const std::array<std::pair<const char*, float*>, 10> places{{{"a", &q.a},
                                                               {"b", &q.b},
                                                               {"c", &q.c},
                                                               {"d", &q.d},
                                                               {"e", &q.e},
                                                               {"f", &q.f},
                                                               {"g", &q.g},
                                                               {"h", &q.h},
                                                               {"i", &q.i},
                                                               {"j", &q.j}}};
  for (const auto& [key, place] : places) {
    if (const auto number = coefficients.find(key)) *place = number->float32();
  }
  return q;
}

Shape read_kind(const JsonReader& json) {
  const JsonReader type = json.member("type");
  const std::string name = type.string();
  if (name == "sphere") return read_sphere(json);
  if (name == "plane") return read_plane(json);
  if (name == "disc") return read_disc(json);
  if (name == "triangle") return read_triangle(json);
  if (name == "quadric") return read_quadric(json);
  type.fail_unknown("type", name, {"sphere", "plane", "disc", "triangle", "quadric", "mesh"});
}

}  // namespace

Shape read_shape(const JsonReader& json) {
  Shape shape = read_kind(json);
  json.require(validate(shape));
  return shape;
}

}  // namespace microtrace::io
