#include "dataset/npz_views.hpp"

#include "base/text/printable.hpp"
#include "io/npz/npy_array.hpp"
#include "io/npz/zip_archive.hpp"
#include "io/scene_json/camera.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/error.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <span>
#include <utility>

namespace microtrace::dataset {
namespace {

using Shape = std::vector<std::size_t>;
using Arrays = std::map<std::string, io::NpyArray, std::less<>>;

/// The values of one view in an array.
struct Item {
  const std::string& file;
  std::string name;  ///< of the item, for messages: "K[3]", or "K" if all views share it
  std::span<const double> values;

  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorKind::invalid_scene, file, name + ": " + message);
  }
  [[nodiscard]] double at(std::size_t row, std::size_t column, std::size_t columns) const {
    return values[row * columns + column];
  }
};

/// An array with one item for each view, or with one item that all views share. Numbers aren't
/// shared.
class Column {
 public:
  /// `shapes` are the accepted shapes of an item.
  Column(const std::string& file, std::string name, const io::NpyArray& array, std::size_t views,
         const std::vector<Shape>& shapes)
      : file_(file), name_(std::move(name)), array_(array) {
    for (const Shape& shape : shapes) {
      Shape of_views = shape;
      of_views.insert(of_views.begin(), views);
      is_shared_ = array.shape == shape && !shape.empty();
      if (!is_shared_ && array.shape != of_views) continue;
      size_ = 1;
      for (const std::size_t extent : shape) size_ *= extent;
      return;
    }
    std::string expected;
    for (const Shape& shape : shapes) {
      Shape of_views = shape;
      of_views.insert(of_views.begin(), views);
      expected.append(expected.empty() ? "" : " or ").append(io::shape_text(of_views));
      if (!shape.empty()) expected.append(" or ").append(io::shape_text(shape));
    }
    throw Error(
        ErrorKind::invalid_scene, file,
        name_ + ": must have the shape " + expected + ", has " + io::shape_text(array.shape));
  }

  [[nodiscard]] Item operator[](std::size_t view) const {
    Item item{.file = file_, .name = name_, .values = array_.values};
    if (!is_shared_) {
      item.name.append("[").append(std::to_string(view)).append("]");
      item.values = item.values.subspan(view * size_, size_);
    }
    if (!std::ranges::all_of(item.values, [](double value) { return std::isfinite(value); }))
      item.fail("must be finite");
    return item;
  }

 private:
  const std::string& file_;
  std::string name_;
  const io::NpyArray& array_;
  std::size_t size_ = 0;
  bool is_shared_ = false;
};

Pose pose_of(const Item& item) {
  DMat4 camera_from_world(1);
  for (std::size_t row = 0; row < 4; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      camera_from_world[static_cast<glm::length_t>(column)][static_cast<glm::length_t>(row)] =
          item.at(row, column, 4);
    }
  }
  const bool is_affine =
      item.values[12] == 0 && item.values[13] == 0 && item.values[14] == 0 && item.values[15] == 1;
  if (!is_affine) item.fail("must have the last row 0, 0, 0, 1");
  if (const char* message = io::broken_rotation(camera_from_world)) item.fail(message);
  return pose_from_opencv(camera_from_world);
}

/// Sets the focal lengths and the principal point.
void set_intrinsics(const Item& item, CalibratedCamera& camera) {
  const bool is_usual = item.at(1, 0, 3) == 0 && item.at(2, 0, 3) == 0 && item.at(2, 1, 3) == 0 &&
                        item.at(2, 2, 3) == 1;
  if (!is_usual) item.fail("must have the form [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]");
  if (item.at(0, 1, 3) != 0) item.fail("must have no skew; cameras with skew are not supported");
  camera.fx = item.at(0, 0, 3);
  camera.fy = item.at(1, 1, 3);
  camera.cx = item.at(0, 2, 3);
  camera.cy = item.at(1, 2, 3);
}

RationalDistortion rational_distortion(const Item& item) {
  const auto value = [&](std::size_t i) { return i < item.values.size() ? item.values[i] : 0; };
  // The order of OpenCV.
  return {.k1 = value(0),
          .k2 = value(1),
          .p1 = value(2),
          .p2 = value(3),
          .k3 = value(4),
          .k4 = value(5),
          .k5 = value(6),
          .k6 = value(7)};
}

ImageSize size_of(const Item& item) {
  const auto side = [&](double value) {
    if (value != std::floor(value) || value < 1)
      item.fail("must be two positive whole numbers, width and height");
    if (value > std::numeric_limits<std::int32_t>::max()) item.fail("is too large");
    return static_cast<std::uint32_t>(value);
  };
  const ImageSize size{.width = side(item.values[0]), .height = side(item.values[1])};
  if (const auto rule = validate(size))
    throw Error(rule->kind, item.file, item.name + ": " + rule->message);
  return size;
}

Arrays read_arrays(std::string_view bytes, const std::string& file) {
  static constexpr std::string_view kNames[] = {"K", "T", "distortion", "fisheye", "size", "time"};
  Arrays arrays;
  const io::ZipArchive archive(bytes, file);
  for (const io::ZipArchive::Entry& entry : archive.entries()) {
    std::string name = entry.name;
    if (name.ends_with(".npy")) name.resize(name.size() - 4);
    const auto fail = [&](const std::string& message) {
      throw Error(ErrorKind::invalid_scene, file, "array " + printable(name) + message);
    };
    if (std::ranges::find(kNames, name) == std::ranges::end(kNames))
      fail(" is unknown; the arrays of views are K, T, distortion, fisheye, size and time");
    if (arrays.contains(name)) fail(" occurs twice");
    arrays.emplace(name, io::read_npy(archive.content(entry), file, name));
  }
  for (const char* name : {"K", "T"}) {
    if (!arrays.contains(name))
      throw Error(ErrorKind::invalid_scene, file, std::string("array ") + name + " is missing");
  }
  if (arrays.contains("distortion") && arrays.contains("fisheye"))
    throw Error(ErrorKind::invalid_scene, file, "distortion must not be combined with fisheye");
  return arrays;
}

}  // namespace

bool is_npz(std::string_view bytes) {
  return bytes.starts_with("PK");
}

std::vector<DatasetView> read_npz_views(std::string_view bytes, const std::string& file,
                                        const std::optional<ImageSize>& image) {
  const Arrays arrays = read_arrays(bytes, file);
  const Shape& shape = arrays.at("T").shape;
  if (shape.size() != 3 || shape[0] == 0 || shape[1] != 4 || shape[2] != 4) {
    throw Error(ErrorKind::invalid_scene, file,
                "T: must have the shape (N, 4, 4) for N views, has " + io::shape_text(shape));
  }
  const std::size_t count = shape[0];
  const auto column = [&](const char* name,
                          const std::vector<Shape>& shapes) -> std::optional<Column> {
    const auto found = arrays.find(name);
    if (found == arrays.end()) return std::nullopt;
    return Column(file, name, found->second, count, shapes);
  };
  const auto poses = column("T", {{4, 4}}), intrinsics = column("K", {{3, 3}});
  const auto rational = column("distortion", {{4}, {5}, {8}}), fisheye = column("fisheye", {{4}});
  const auto sizes = column("size", {{2}}), times = column("time", {{}});
  if (!sizes && !image) {
    throw Error(ErrorKind::invalid_scene, file,
                "array size is missing: add it, with width and height, or choose one (--size)");
  }
  std::vector<DatasetView> views(count);
  for (std::size_t i = 0; i < count; ++i) {
    DatasetView& view = views[i];
    CalibratedCamera camera;
    camera.pose = pose_of((*poses)[i]);
    camera.image = sizes ? size_of((*sizes)[i]) : *image;
    set_intrinsics((*intrinsics)[i], camera);
    if (rational) camera.distortion = rational_distortion((*rational)[i]);
    if (fisheye) {
      const std::span<const double> k = (*fisheye)[i].values;
      camera.distortion = FisheyeDistortion{.k1 = k[0], .k2 = k[1], .k3 = k[2], .k4 = k[3]};
    }
    if (const auto rule = validate(Camera(camera))) {
      throw Error(rule->kind, file,
                  "view " + std::to_string(i) + ": " + rule->field + " " + rule->message);
    }
    if (sizes) view.size = camera.image;
    view.camera = camera;
    if (times) {
      const Item item = (*times)[i];
      if (!(item.values[0] >= 0)) item.fail("must not be negative");
      view.time = item.values[0];
    }
  }
  return views;
}

}  // namespace microtrace::dataset
