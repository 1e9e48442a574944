#include "base/system/float_environment.hpp"
#include "io/sidecar/seen_pixels.hpp"
#include "scene/shape_name.hpp"
#include "scene/support.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/sidecar.hpp>

#include <array>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <string_view>

#include <glm/matrix.hpp>
#include <nlohmann/json.hpp>

namespace microtrace {
namespace {

std::string quoted(const std::string& text) {
  using Json = nlohmann::json;
  return Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Writes a number. Writes null for infinity, which JSON can't express.
std::string number(double x) {
  return std::isfinite(x) ? decimal(x) : "null";
}
std::string number(std::uint32_t x) {
  return std::to_string(x);
}

template <typename Number>
std::string array(std::initializer_list<Number> numbers) {
  std::string text = "[";
  for (const Number x : numbers) text.append(text.size() > 1 ? ", " : "").append(number(x));
  return text += ']';
}

std::string array(const DVec3& v) {
  return array({v.x, v.y, v.z});
}

std::string rows(const DMat4& m) {
  std::string text = "[";
  for (glm::length_t r = 0; r < 4; ++r) {
    text.append(r > 0 ? ", " : "").append(array({m[0][r], m[1][r], m[2][r], m[3][r]}));
  }
  return text += ']';
}

/// Returns the inverse of a rigid transform. It is computed by transposing the rotation, without
/// division.
DMat4 inverse(const DMat4& rigid) {
  const glm::dmat3 back = glm::transpose(glm::dmat3(rigid));
  DMat4 result(back);
  result[3] = DVec4(-(back * DVec3(rigid[3])), 1);
  return result;
}

std::string members(const RationalDistortion& d) {
  std::string text = R"("type": "rational")";
  const auto add = [&](std::string_view name, double value) {
    text.append(", \"").append(name).append("\": ").append(number(value));
  };
  add("k1", d.k1), add("k2", d.k2), add("p1", d.p1), add("p2", d.p2);
  add("k3", d.k3), add("k4", d.k4), add("k5", d.k5), add("k6", d.k6);
  return text;
}
std::string members(const FisheyeDistortion& d) {
  return R"("type": "fisheye", "k1": )" + number(d.k1) + R"(, "k2": )" + number(d.k2) +
         R"(, "k3": )" + number(d.k3) + R"(, "k4": )" + number(d.k4);
}

std::string camera_text(const Camera& camera, ImageSize size, const DVec3& origin) {
  constexpr std::array kTypes = {"perspective", "orthographic", "environment", "calibrated"};
  static_assert(std::variant_size_v<Camera> == kTypes.size());
  CameraModel model = RayGenerator(camera, size).model();
  model.world_from_camera[3] += DVec4(origin, 0);
  std::string text = "{\n    \"type\": \"";
  text.append(kTypes.at(camera.index())).append("\",\n");
  text.append("    \"axes\": \"x right, y up, z backward\",\n");
  text.append("    \"world_from_camera\": ").append(rows(model.world_from_camera)).append(",\n");
  text.append("    \"camera_from_world\": ").append(rows(inverse(model.world_from_camera)));
  if (model.pixels_per_unit.x > 0) {
    const DVec2 scale = model.pixels_per_unit;
    if (std::holds_alternative<OrthographicCamera>(camera)) {
      text.append(",\n    \"pixels_per_unit\": ").append(number(scale.x));
    } else {
      text.append(",\n    \"fx\": ").append(number(scale.x));
      text.append(", \"fy\": ").append(number(scale.y));
    }
    text.append(", \"cx\": ").append(number(model.center.x));
    text.append(", \"cy\": ").append(number(model.center.y));
    if (model.distortion) {
      text.append(",\n    \"distortion\": {");
      text.append(std::visit([](const auto& d) { return members(d); }, *model.distortion));
      text.append("}");
    }
    const auto* perspective = std::get_if<PerspectiveCamera>(&camera);
    if (perspective != nullptr && perspective->lens_radius > 0) {
      text.append(",\n    \"lens_radius\": ").append(number(perspective->lens_radius));
      text.append(", \"focus\": ").append(number(perspective->focus));
    }
    text.append(",\n    \"near\": ").append(number(model.depth.near));
    text.append(", \"far\": ").append(number(model.depth.far));
  }
  return text += "\n  }";
}

/// Describes the object with this index.
std::string object_text(const Scene& scene, std::size_t index, const io::SeenPixels* seen,
                        ChunkedMeshes& chunks) {
  const ObjectRun run = scene.objects.run(scene.objects.run_of(index));
  const std::optional<std::uint32_t> material = run.first->material;
  std::string text = "{\"id\": " + std::to_string(index + 1);
  text.append(", \"name\": ").append(quoted(scene.objects.name(index).str()));
  text.append(", \"type\": \"").append(type_name(run.first->shape)).append("\"");
  text.append(", \"material\": ").append(std::to_string(material ? *material + 1 : 0));
  if (seen != nullptr) {
    const PixelRect& box = seen->box;
    text.append(", \"visible_pixels\": ").append(std::to_string(seen->count));
    text.append(", \"box\": ");
    text.append(seen->count > 0 ? array({box.x0, box.y0, box.x1, box.y1}) : "null");
  }
  text.append(", \"world_box\": ");
  if (const auto extent = extent_of({run, index - run.begin}, chunks)) {
    text.append("{\"min\": ").append(array(scene.origin + extent->low));
    text.append(", \"max\": ").append(array(scene.origin + extent->high)).append("}");
  } else {
    text.append("null");
  }
  return text += '}';
}

/// Appends a JSON array with one item per line.
template <class Item>
void append_list(std::string& text, std::size_t count, Item&& item) {
  // There may be millions of items. Without this, the text would be copied when it grows.
  constexpr std::size_t kBytesOfItem = 300;
  text.reserve(text.size() + count * kBytesOfItem);
  text.append("[");
  for (std::size_t i = 0; i < count; ++i) {
    text.append(i > 0 ? ",\n    " : "\n    ").append(item(i));
  }
  text.append(count > 0 ? "\n  ]" : "]");
}

}  // namespace

std::string describe_picture(const Scene& scene, const Camera& camera, const Film& film,
                             const std::string& picture,
                             const std::optional<ShutterTimes>& shutter) {
  const FloatEnvironment environment;
  const auto seen = io::find_seen_pixels(film, scene.objects.size());
  const ImageSize size = film.size();
  std::string text = "{\n  \"version\": 1,\n  \"picture\": " + quoted(picture);
  text.append(",\n  \"width\": ").append(number(film.whole.width));
  text.append(",\n  \"height\": ").append(number(film.whole.height));
  text.append(",\n  \"crop\": ");
  text.append(array({film.x0, film.y0, film.x0 + size.width, film.y0 + size.height}));
  if (!film.denoiser.empty()) text.append(",\n  \"denoiser\": ").append(quoted(film.denoiser));
  if (shutter) {
    text.append(",\n  \"shutter\": {\"open\": ").append(number(shutter->open));
    text.append(", \"close\": ").append(number(shutter->close));
    text.append(", \"times\": ").append(number(shutter->count)).append("}");
  }
  text.append(",\n  \"camera\": ").append(camera_text(camera, film.whole, scene.origin));
  text.append(",\n  \"objects\": ");
  ChunkedMeshes chunks;
  append_list(text, scene.objects.size(), [&](std::size_t i) {
    return object_text(scene, i, seen ? &(*seen)[i] : nullptr, chunks);
  });
  text.append(",\n  \"materials\": ");
  append_list(text, scene.materials.size(), [&](std::size_t i) {
    return "{\"id\": " + std::to_string(i + 1) + ", \"name\": " + quoted(scene.materials[i].name) +
           "}";
  });
  text += "\n}\n";
  return text;
}

}  // namespace microtrace
