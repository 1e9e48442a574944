#include "dataset/annotations/bop.hpp"

#include "base/counted.hpp"
#include "dataset/annotations/bop_names.hpp"
#include "dataset/annotations/json_text.hpp"
#include "dataset/annotations/mesh_points.hpp"
#include "io/image/encode/png.hpp"
#include "scene/support.hpp"

#include <microtrace/annotations.hpp>
#include <microtrace/camera.hpp>

#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace microtrace::dataset {
namespace {

/// The transform from scene coordinates to camera space with x right, y down and z forward.
struct CameraFrame {
  explicit CameraFrame(const CameraModel& model) {
    for (glm::length_t row = 0; row < 3; ++row) {
      const double sign = row == 0 ? 1 : -1;
      axes[static_cast<std::size_t>(row)] = sign * DVec3(model.world_from_camera[row]);
    }
    position = DVec3(model.world_from_camera[3]);
  }

  [[nodiscard]] std::array<double, 9> rotation() const {
    std::array<double, 9> result{};
    for (std::size_t k = 0; k < 9; ++k)
      result[k] = axes[k / 3][static_cast<glm::length_t>(k % 3)] + 0.0;  // -0 becomes 0
    return result;
  }
  /// Returns the point in camera space, times `scale`.
  [[nodiscard]] std::array<double, 3> of(const DVec3& point, double scale) const {
    const DVec3 way = point - position;
    std::array<double, 3> result{};
    for (std::size_t k = 0; k < 3; ++k)
      result[k] = (axes[k].x * way.x + axes[k].y * way.y + axes[k].z * way.z) * scale + 0.0;
    return result;
  }

  std::array<DVec3, 3> axes;
  DVec3 position;
};

/// Returns a bounding box as bop_toolkit computes it: corner, and differences of the pixels'
/// coordinates.
std::string bop_box(const Mask* mask) {
  if (mask == nullptr) return "[-1,-1,-1,-1]";
  const PixelRect& box = mask->box();
  return json_array(std::array{box.x0, box.y0, box.size().width - 1, box.size().height - 1});
}

std::string mask_png(const Mask* mask, ImageSize size) {
  std::vector<std::uint8_t> samples(std::size_t{size.width} * size.height);
  if (mask != nullptr) {
    for (const PixelRun& run : mask->runs()) {
      const auto row =
          samples.begin() + static_cast<std::ptrdiff_t>(std::size_t{run.y} * size.width);
      std::fill(row + run.x0, row + run.x1, std::uint8_t{255});
    }
  }
  return io::encode_gray_png(size, samples);
}

struct DepthSteps {
  std::vector<std::uint16_t> steps;       // 0: no depth
  std::size_t too_far = 0, too_near = 0;  // the numbers of depths without a step
};

DepthSteps depth_steps(std::span<const float> depth, const BopOptions& options) {
  DepthSteps result;
  result.steps.reserve(depth.size());
  for (const float z : depth) {
    const double step =
        std::floor(double{z} * options.millimeters_per_unit / options.depth_scale + 0.5);
    const bool is_far = step > std::numeric_limits<std::uint16_t>::max();
    if (is_far && std::isfinite(z)) ++result.too_far;
    const bool has_step = step > 0 && !is_far;
    if (z > 0 && !(step > 0)) ++result.too_near;
    result.steps.push_back(has_step ? static_cast<std::uint16_t>(step) : std::uint16_t{0});
  }
  return result;
}

std::uint64_t valid_pixels(const Mask& mask, const std::vector<std::uint16_t>& depth,
                           std::uint32_t width) {
  std::uint64_t count = 0;
  for (const PixelRun& run : mask.runs()) {
    for (std::uint32_t x = run.x0; x < run.x1; ++x)
      count += depth[std::size_t{run.y} * width + x] != 0 ? 1U : 0U;
  }
  return count;
}

/// The warning about depths that are stored as 0, if there are any.
std::optional<Diagnostic> warning_about(std::uint32_t view, std::size_t count, const char* place,
                                        const char* remedy) {
  if (count == 0) return std::nullopt;
  Diagnostic warning;
  warning.message = "view " + std::to_string(view) + " stores " + counted(count, "depth") + place +
                    " as 0, and other views may, too; " + remedy;
  return warning;
}

bool is_scale(double x) {
  return x > 0 && std::isfinite(x);
}

void check(const DrawnView& view, const BopOptions& options) {
  require_bop_camera(*view.camera, "");
  if (!is_scale(options.millimeters_per_unit) || !is_scale(options.depth_scale))
    throw Error(ErrorKind::usage, "", "scales must be positive, finite numbers");
  if (view.depth.size() != std::size_t{view.size.width} * view.size.height)
    throw Error(ErrorKind::usage, "", "a view needs a depth for each of its pixels");
}

/// Returns the value of scene_camera.json for an image.
std::string camera_json(const CameraModel& model, const CameraFrame& frame, const DVec3& world,
                        const BopOptions& options) {
  const std::array<double, 9> k{model.pixels_per_unit.x,
                                0,
                                model.center.x - 0.5,
                                0,
                                model.pixels_per_unit.y,
                                model.center.y - 0.5,
                                0,
                                0,
                                1};
  return JsonText('{')
      .json_member("cam_K", json_array(k))
      .json_member("cam_R_w2c", json_array(frame.rotation()))
      .json_member("cam_t_w2c", json_array(frame.of(world, options.millimeters_per_unit)))
      .member("depth_scale", options.depth_scale)
      .text();
}

}  // namespace

BopFrames::BopFrames(const Scene& scene) {
  origins_.reserve(scene.objects.size());
  for (const Object& object : scene.objects) {
    DVec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const Vec3& point : mesh_points(object.shape)) {
      if (!is_finite(point))
        throw Error(ErrorKind::usage, "",
                    "object " + object.name.str() +
                        " has vertices that are not finite, which BOP can't describe; move or "
                        "scale it, or choose other formats");
      low = glm::min(low, DVec3(point));
      high = glm::max(high, DVec3(point));
    }
    origins_.push_back(low.x <= high.x ? (low + high) * 0.5 : DVec3(0));
  }
}

BopAnnotations bop_view(const DrawnView& view, const BopFrames& frames, const Masks& visible,
                        const Masks& amodal, const BopOptions& options) {
  check(view, options);
  const Scene& scene = view.scene->scene();
  const CameraModel model = RayGenerator(*view.camera, view.size).model();
  const CameraFrame frame(model);
  BopAnnotations result;
  const DepthSteps depth = depth_steps(view.depth, options);
  const bool are_both = depth.too_far > 0 && depth.too_near > 0;
  const char* const none = "no depth scale suits all depths of this view";
  result.too_far = warning_about(view.index, depth.too_far, " beyond 65535 steps",
                                 are_both ? none : "choose a larger depth scale");
  result.too_near = warning_about(view.index, depth.too_near, " below half a step",
                                  are_both ? none : "choose a smaller depth scale");
  const std::string number = six_digits(view.index);
  result.files.push_back(
      {.name = "depth/" + number + ".png", .bytes = io::encode_gray_png(view.size, depth.steps)});
  JsonText gt('['), info('[');
  std::uint32_t index = 0;
  for (const auto& [object, mask] : amodal) {
    const Mask* seen = find_mask(visible, object);
    const std::uint64_t area = seen != nullptr ? seen->area() : 0;
    gt.json_item(JsonText('{')
                     .json_member("cam_R_m2c", json_array(frame.rotation()))
                     .json_member("cam_t_m2c", json_array(frame.of(frames.origin(object),
                                                                   options.millimeters_per_unit)))
                     .member("obj_id", options.first_object_id + object)
                     .text());
    info.json_item(
        JsonText('{')
            .json_member("bbox_obj", bop_box(seen != nullptr ? &mask : nullptr))
            .json_member("bbox_visib", bop_box(seen))
            .member("px_count_all", mask.area())
            .member("px_count_valid", valid_pixels(mask, depth.steps, view.size.width))
            .member("px_count_visib", area)
            .member("visib_fract", static_cast<double>(area) / static_cast<double>(mask.area()))
            .text());
    const std::string name = number + "_" + six_digits(index++) + ".png";
    std::string whole = mask_png(&mask, view.size);
    // The visible mask is a part of the amodal one, so they are equal if their areas are.
    std::string visible_part = area == mask.area() ? whole : mask_png(seen, view.size);
    result.files.push_back({.name = "mask/" + name, .bytes = std::move(whole)});
    result.files.push_back({.name = "mask_visib/" + name, .bytes = std::move(visible_part)});
  }
  // The scene's origin is at (0, 0, 0) in scene coordinates, so world space begins at -origin.
  result.part = std::to_string(view.index) + "\n" +
                camera_json(model, frame, -scene.origin, options) + "\n" + gt.text() + "\n" +
                info.text() + "\n";
  return result;
}

void join_bop(BopFile file, std::size_t count, const std::function<std::string(std::size_t)>& part,
              const std::function<void(std::string_view)>& out) {
  std::string text = "{";
  for (std::size_t i = 0; i < count; ++i) {
    const std::string bytes = part(i);
    std::vector<std::string_view> lines;
    for (std::string_view left = bytes; left.find('\n') != std::string_view::npos;) {
      lines.push_back(left.substr(0, left.find('\n')));
      left.remove_prefix(lines.back().size() + 1);
    }
    if (lines.size() != 4 || !bytes.ends_with("]\n"))
      throw Error(ErrorKind::io, "",
                  "the BOP annotations of view " + std::to_string(i) +
                      " are incomplete; render this view again");
    text.append(i == 0 ? "\n  \"" : ",\n  \"").append(lines[0]).append("\": ");
    out(text.append(lines[1 + static_cast<std::size_t>(file)]));
    text.clear();
  }
  out(text + "\n}\n");
}

}  // namespace microtrace::dataset
