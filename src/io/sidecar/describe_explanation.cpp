#include "base/system/float_environment.hpp"

#include <microtrace/explain.hpp>

#include <cmath>
#include <string>
#include <type_traits>
#include <variant>

#include <nlohmann/json.hpp>

namespace microtrace {
namespace {

using Json = nlohmann::ordered_json;

/// Returns a number, or a string for infinity, which JSON can't express.
Json number(double x) {
  if (std::isinf(x)) return x > 0 ? "Infinity" : "-Infinity";
  return x;
}

template <class Number>
Json optional_number(const std::optional<Number>& x) {
  return x ? number(*x) : Json();
}

/// Returns an array of a vector's components.
template <class AnyVector>
Json array(const AnyVector& v) {
  Json result = Json::array();
  for (glm::length_t k = 0; k < AnyVector::length(); ++k) result.push_back(number(v[k]));
  return result;
}

template <class AnyVector>
Json optional_array(const std::optional<AnyVector>& v) {
  return v ? array(*v) : Json();
}

Json numbers_json(const QuadraticNumbers& n) {
  Json roots = Json::array();
  for (const double root : n.roots) roots.push_back(number(root));
  return {
      {"kind", "quadratic"},
      {"a", number(n.a)},
      {"b", number(n.b)},
      {"c", number(n.c)},
      {"discriminant", number(n.discriminant)},
      {"signs",
       {{"a", n.a_sign}, {"b", n.b_sign}, {"c", n.c_sign}, {"discriminant", n.discriminant_sign}}},
      {"roots", roots}};
}

Json numbers_json(const PlaneNumbers& n) {
  return {{"kind", "plane"},
          {"slope", number(n.slope)},
          {"height", number(n.height)},
          {"signs", {{"slope", n.slope_sign}, {"height", n.height_sign}}},
          {"t", optional_number(n.t)}};
}

Json numbers_json(const DiscNumbers& n) {
  return {{"kind", "disc"},
          {"plane", numbers_json(n.plane)},
          {"squared_distance", optional_number(n.squared_distance)},
          {"squared_radius", number(n.squared_radius)},
          {"side", n.side},
          {"ball", n.ball ? numbers_json(*n.ball) : Json()}};
}

Json numbers_json(const TriangleNumbers& n) {
  Json volumes = Json::array();
  for (const double volume : n.volumes) volumes.push_back(number(volume));
  Json stretch;
  if (n.stretch) stretch = {number((*n.stretch)[0]), number((*n.stretch)[1])};
  return {{"kind", "triangle"}, {"plane", numbers_json(n.plane)}, {"volumes", volumes},
          {"signs", n.signs},   {"place", place_in_triangle(n)},  {"stretch", stretch}};
}

Json primitive_json(const ExplainedPrimitive& p) {
  Json numbers = std::visit(
      []<class Numbers>(const Numbers& n) -> Json {
        if constexpr (std::is_same_v<Numbers, std::monostate>)
          return nullptr;
        else
          return numbers_json(n);
      },
      p.numbers);
  return {{"id", p.id},
          {"object", p.object},
          {"name", p.name},
          {"primitive", p.primitive},
          {"type", p.type},
          {"decided_by", name_of(p.decided_by)},
          {"numbers", std::move(numbers)},
          {"derivation", p.derivation}};
}

Json hit_json(const ExplainedHit& hit) {
  Json json{{"verdict", name_of(hit.verdict)},
            {"t", number(hit.t)},
            {"exact_t", number(hit.exact_t)},
            {"rounded_by", name_of(hit.rounded_by)},
            {"order", name_of(hit.order)},
            {"distance", number(hit.distance)},
            {"depth", optional_number(hit.depth)},
            {"position", array(hit.position)},
            {"normal", array(hit.n)},
            {"shading_normal", array(hit.ns)},
            {"front", hit.front},
            {"uv", optional_array(hit.uv)},
            {"barycentrics", optional_array(hit.barycentrics)},
            {"material", nullptr},
            {"alpha",
             {{"mode", name_of(hit.alpha_mode)},
              {"value", number(hit.alpha)},
              {"cutoff", number(hit.alpha_cutoff)},
              {"coverage", number(hit.coverage)},
              {"weight", number(hit.weight)}}}};
  if (hit.material) json["material"] = {{"index", *hit.material}, {"name", hit.material_name}};
  json.update(primitive_json(hit.primitive));
  return json;
}

Json crossing_json(const ExplainedCrossing& crossing) {
  Json json{{"place", crossing.is_before ? "before" : "beyond"},
            {"t", number(crossing.t)},
            {"position", array(crossing.position)}};
  json.update(primitive_json(crossing.primitive));
  return json;
}

Json miss_json(const ExplainedMiss& miss) {
  Json json{{"reason", miss.reason}};
  json.update(primitive_json(miss.primitive));
  return json;
}

std::string text_of(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Returns a JSON array with one item per line.
template <class Items, class Describe>
std::string lines(const Items& items, const Describe& describe) {
  std::string text = "[";
  for (const auto& item : items)
    text.append(text.size() > 1 ? ",\n    " : "\n    ").append(text_of(describe(item)));
  return text.append(items.empty() ? "]" : "\n  ]");
}

Json ray_json(const Explanation& e) {
  return {{"origin", array(e.ray.o)},     {"direction", array(e.ray.d)},
          {"t_min", number(e.ray.t_min)}, {"t_max", number(e.ray.t_max)},
          {"valid", e.is_valid},          {"scene_origin", array(e.scene_origin)}};
}

Json pixel_json(const ExplainedPixel& pixel) {
  return {{"x", pixel.x},
          {"y", pixel.y},
          {"width", pixel.size.width},
          {"height", pixel.size.height},
          {"camera", pixel.camera},
          {"derivation", "docs/derivations.md#camera-ray"}};
}

Json stages_json(const StageCounts& stages) {
  return {{"edges", stages.edges},
          {"filters", stages.filters},
          {"grid", stages.grid},
          {"dyadic", stages.dyadic}};
}

}  // namespace

std::string explanation_json(const Explanation& e) {
  const FloatEnvironment environment;
  std::string text = "{\n  \"version\": 1";
  const auto add = [&](const std::string& name, const std::string& value) {
    text.append(",\n  \"").append(name).append("\": ").append(value);
  };
  add("ray", text_of(ray_json(e)));
  add("pixel", e.pixel ? text_of(pixel_json(*e.pixel)) : "null");
  add("primitives", std::to_string(e.primitives));
  add("stages", text_of(stages_json(e.stages)));
  add("visible", e.visible ? std::to_string(*e.visible) : "null");
  add("hit_count", std::to_string(e.hit_count));
  add("hits", lines(e.hits, hit_json));
  add("crossing_count", std::to_string(e.crossing_count));
  add("crossings", lines(e.crossings, crossing_json));
  add("misses", e.misses ? lines(*e.misses, miss_json) : "null");
  return text += "\n}\n";
}

}  // namespace microtrace
