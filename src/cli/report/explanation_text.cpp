#include "cli/report/explanation_text.hpp"

#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "scene/validate/validate.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>
#include <variant>

namespace microtrace::cli {
namespace {

/// Returns a number with nine significant digits, which distinguish all float32 numbers.
std::string number(double x) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.9g", x + 0.0);  // without the sign of -0
  return text.data();
}

template <class AnyVector>
std::string vector_text(const AnyVector& v) {
  std::string text = "(";
  for (glm::length_t k = 0; k < AnyVector::length(); ++k)
    text.append(k > 0 ? ", " : "").append(number(v[k]));
  return text += ')';
}

/// "< 0", "= 0" or "> 0", as decided exactly.
std::string_view sign_text(int sign) {
  return sign < 0 ? " < 0" : sign > 0 ? " > 0" : " = 0";
}

/// Returns an indented line with a label.
std::string line(std::string_view label, const std::string& text) {
  std::string result = "    ";
  result.append(label).append(label.size() < 11 ? 11 - label.size() : 1, ' ');
  return result.append(text).append("\n");
}

std::string text_of(const std::monostate&) {
  return line("numbers", "none: the ray is invalid or the shape is empty");
}

std::string text_of(const QuadraticNumbers& n) {
  std::string text = line("equation", "a t^2 + b t + c = 0 with a = " + number(n.a) +
                                          ", b = " + number(n.b) + ", c = " + number(n.c));
  std::string result;
  if (n.a_sign != 0) {
    result = "b^2 - 4 a c = " + number(n.discriminant);
    result.append(n.discriminant_sign == 0 ? ", exactly 0" : "");
    result.append(n.discriminant_sign == 0 ? ": tangent at t = "
                  : n.roots.empty()        ? " < 0: no root"
                                           : " > 0: t = ");
  } else if (n.b_sign != 0) {
    result = "a is exactly 0, so the equation is linear: t = ";
  } else {
    result = n.c_sign == 0 ? "a, b and c are exactly 0: the line lies in the surface"
                           : "a and b are exactly 0, but c is not: no root";
  }
  for (std::size_t i = 0; i < n.roots.size(); ++i)
    result.append(i > 0 ? " and " : "").append(number(n.roots[i]));
  return text + line(n.a_sign != 0 ? "roots" : "root", result);
}

std::string text_of(const PlaneNumbers& n) {
  std::string text = "n.(p - o) / n.d = " + number(n.height) + " / " + number(n.slope);
  if (n.t) {
    text.append(": t = ").append(number(*n.t));
  } else {
    text.append(n.height_sign == 0 ? ": the line lies in the plane" : ": parallel to the plane");
  }
  return line("plane", text);
}

std::string text_of(const DiscNumbers& n) {
  std::string text = text_of(n.plane);
  if (n.ball) return text + text_of(*n.ball);
  if (!n.squared_distance) return text;
  return text + line("disc", "|p - c|^2 - r^2 = " + number(*n.squared_distance) + " - " +
                                 number(n.squared_radius) + std::string(sign_text(n.side)));
}

std::string text_of(const TriangleNumbers& n) {
  constexpr std::array<std::string_view, 3> kEdges = {"bc", "ca", "ab"};
  std::string edges;
  for (std::size_t i = 0; i < 3; ++i) {
    edges.append(i > 0 ? ", " : "").append(kEdges[i]).append(": ");
    edges.append(n.signs[i] == 0 ? "exactly 0" : number(n.volumes[i]));
  }
  const std::string place = place_in_triangle(n);
  std::string text = text_of(n.plane) + line("edges", edges);
  // The reason of a miss already tells where the line passes outside.
  if (!place.starts_with("outside")) text += line("place", place);
  if (n.stretch) {
    text += line("stretch", "t from " + number((*n.stretch)[0]) + " to " + number((*n.stretch)[1]));
  }
  return text;
}

std::string title(const ExplainedPrimitive& p) {
  std::string text = std::string(p.type) + " " + std::to_string(p.object);
  if (!p.name.empty()) text.append(" ").append(in_quotes(p.name));
  if (p.type == "mesh") text.append(", triangle ").append(std::to_string(p.primitive));
  return text;
}

/// Returns the lines about the numbers of a primitive.
std::string numbers_text(const ExplainedPrimitive& p) {
  return std::visit([](const auto& n) { return text_of(n); }, p.numbers) +
         line("derived in", std::string(p.derivation));
}

std::string verdict_text(const ExplainedHit& hit) {
  const std::string alpha = number(hit.alpha);
  switch (hit.verdict) {
    case Verdict::visible:
      return hit.coverage < 1 ? "visible, with coverage " + number(hit.coverage) : "visible";
    case Verdict::seen_through:
      return "seen through the surfaces before it, with coverage " + number(hit.coverage);
    case Verdict::hidden:
      return "hidden behind an opaque surface";
    case Verdict::culled:
      return "culled: the back of a one-sided surface";
    case Verdict::masked:
      return "masked: alpha " + alpha + " is below the cutoff " + number(hit.alpha_cutoff);
    case Verdict::transparent:
      return "transparent: alpha is " + alpha;
    case Verdict::repeated:
      return "not counted again: the same point of the same mesh";
  }
  return {};
}

std::string order_text(OrderDecision order) {
  switch (order) {
    case OrderDecision::first:
      return "";
    case OrderDecision::bounds:
      return "; order by float64 bounds";
    case OrderDecision::exact:
      return "; order by exact comparison";
    case OrderDecision::tie:
      return "; t is exactly equal to that of the previous hit, so the lower id comes first";
  }
  return {};
}

std::string hit_text(const ExplainedHit& hit, std::size_t index) {
  std::string text = "\n" + std::to_string(index + 1) + ". t = " + decimal(hit.t) + "  " +
                     title(hit.primitive) + "\n";
  text += line("verdict", verdict_text(hit));
  std::string place = vector_text(hit.position) + ", distance " + number(hit.distance);
  if (hit.depth) place.append(", depth ").append(number(*hit.depth));
  text += line("position", place);
  text += line("normal", vector_text(hit.n) + (hit.front ? ", front side" : ", back side"));
  if (hit.ns != hit.n) text += line("shading", vector_text(hit.ns));
  if (hit.barycentrics) text += line("weights", vector_text(*hit.barycentrics) + " of a, b and c");
  if (hit.uv) text += line("uv", vector_text(*hit.uv));
  if (hit.material) {
    std::string material = std::to_string(*hit.material);
    if (!hit.material_name.empty()) material.append(" ").append(in_quotes(hit.material_name));
    text += line("material", material + ", alpha mode " + std::string(name_of(hit.alpha_mode)));
  }
  text += numbers_text(hit.primitive);
  return text +
         line("decided by", std::string(name_of(hit.primitive.decided_by)) + "; t by " +
                                std::string(name_of(hit.rounded_by)) + order_text(hit.order));
}

std::string crossing_text(const ExplainedCrossing& crossing) {
  return "\nt = " + number(crossing.t) + "  " + title(crossing.primitive) + "\n" +
         line("position", vector_text(crossing.position)) + numbers_text(crossing.primitive) +
         line("decided by", std::string(name_of(crossing.primitive.decided_by)));
}

std::string miss_text(const ExplainedMiss& miss) {
  return "\n" + title(miss.primitive) + "\n" + line("reason", miss.reason) +
         numbers_text(miss.primitive) +
         line("decided by", std::string(name_of(miss.primitive.decided_by)));
}

std::string ray_text(const Explanation& e) {
  std::string text;
  if (e.pixel) {
    text = "Pixel       " + vector_text(DVec2(e.pixel->x, e.pixel->y) - 0.5) + " of " +
           std::to_string(e.pixel->size.width) + " x " + std::to_string(e.pixel->size.height);
    if (!e.pixel->camera.empty()) text.append(", camera ").append(in_quotes(e.pixel->camera));
    text.append(", docs/derivations.md#camera-ray\n");
  }
  text.append("Origin o    ").append(vector_text(e.ray.o));
  if (e.scene_origin != DVec3(0)) text.append(" + ").append(vector_text(e.scene_origin));
  text.append("\nDirection d ").append(vector_text(e.ray.d));
  text.append("\nInterval    t from ").append(decimal(e.ray.t_min));
  text.append(" to ").append(number(e.ray.t_max)).append(", docs/derivations.md#the-interval\n");
  if (!e.is_valid) text.append("The ray is invalid, so it hits nothing.\n");
  text.append("Tests       for the nearest hit: ").append(std::to_string(e.stages.edges));
  text.append(" edges and ").append(std::to_string(e.stages.filters));
  text.append(" filters in float64, ").append(std::to_string(e.stages.grid));
  text.append(" grid, ").append(std::to_string(e.stages.dyadic)).append(" dyadic\n");
  return text;
}

/// Returns a heading, such as "2 hits:", with the number of items that are listed if not all are.
std::string heading(std::uint64_t count, std::size_t listed, std::string_view singular,
                    std::string_view plural, std::string_view rest) {
  std::string text = "\n" + (count == 0 ? "No" : std::to_string(count)) + " ";
  text.append(count == 1 ? singular : plural).append(rest);
  if (listed < count) text.append("; the first ").append(std::to_string(listed)).append(" (--all)");
  return text.append(count > 0 ? ":\n" : "\n");
}

}  // namespace

std::string explanation_text(const Explanation& e) {
  std::string text = ray_text(e);
  text += heading(
      e.hit_count, e.hits.size(), "hit", "hits",
      " among " + counted(e.primitives, "primitive") + (e.hit_count > 1 ? ", nearest first" : ""));
  for (std::size_t i = 0; i < e.hits.size(); ++i) text += hit_text(e.hits[i], i);
  if (e.visible && *e.visible >= e.hits.size())
    text.append("\nHit ").append(std::to_string(*e.visible + 1)).append(" is visible.\n");
  if (e.hit_count > 0 && !e.visible) text += "\nNo hit is visible.\n";
  if (e.crossing_count > 0) {
    text += heading(e.crossing_count, e.crossings.size(), "crossing", "crossings",
                    " of the line outside of the interval");
    for (const ExplainedCrossing& crossing : e.crossings) text += crossing_text(crossing);
  }
  if (!e.misses) return text + "\nThe misses are not listed (--all).\n";
  if (e.misses->empty()) return text;
  text += heading(e.misses->size(), e.misses->size(), "primitive", "primitives", " missed");
  for (const ExplainedMiss& miss : *e.misses) text += miss_text(miss);
  return text;
}

}  // namespace microtrace::cli
