/// Binds loading and preparing of scenes.

#include "base/system/float_environment.hpp"
#include "common.hpp"
#include "member_names.hpp"
#include "prepared.hpp"
#include "scene/math/srgb.hpp"
#include "scene/support.hpp"
#include "scene_reader.hpp"
#include "scene_writer.hpp"

#include <array>
#include <memory>
#include <mutex>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>
#include <string>
#include <utility>
#include <vector>

namespace microtrace::python {
namespace {

SurfaceDetail detail_named(const std::string& name) {
  if (name == "shape") return SurfaceDetail::shape;
  if (name == "color") return SurfaceDetail::color;
  if (name == "shape_and_color") return SurfaceDetail::shape_and_color;
  if (name == "all") return SurfaceDetail::all;
  throw nb::value_error("detail must be one of shape, color, shape_and_color, all");
}

/// A scene file that threads of Python may share.
struct SharedFile {
  SharedFile(const std::filesystem::path& path, LoadOptions options)
      : file(path, std::move(options)) {}

  SceneFile file;
  std::mutex mutex;  // SceneFile::at() changes the file's state
};

std::unique_ptr<SharedFile> open(const std::filesystem::path& path, const std::string& detail,
                                 std::string variant, std::string animation,
                                 std::vector<std::filesystem::path> allowed_folders) {
  LoadOptions options{.detail = detail_named(detail),
                      .variant = std::move(variant),
                      .animation = std::move(animation),
                      .allowed_folders = std::move(allowed_folders)};
  return result_unlocked([&] { return std::make_unique<SharedFile>(path, std::move(options)); });
}

nb::tuple at(SharedFile& shared, std::optional<double> time) {
  LoadedScene loaded;
  run_unlocked([&] {
    const std::scoped_lock lock(shared.mutex);
    loaded = shared.file.at(time);
  });
  const bool is_json = loaded.format == SceneFormat::json;
  return nb::make_tuple(scene_to_python(loaded.scene, is_json, is_json),
                        to_python(loaded.warnings));
}

void prepare(Prepared* self, const nb::object& source, const nb::object& previous, unsigned threads,
             bool fast_build) {
  const FloatEnvironment environment;
  std::string integrator;
  if (!nb::try_cast(source.attr("integrator"), integrator) ||
      (integrator != "path" && integrator != "flat"))
    throw nb::value_error("integrator must be \"path\" or \"flat\"");
  const bool has_background = !source.attr("background").is_none();
  Scene scene = scene_from_python(source);
  PrepareOptions options{.fast_build = fast_build, .threads = threads};
  if (!previous.is_none()) options.tables = nb::cast<const Prepared&>(previous).scene.tables();
  run_unlocked([&] {
    with_python_names([&] { validate(scene); });
    new (self) Prepared{PreparedScene(std::move(scene), std::move(options)), integrator == "flat",
                        has_background};
  });
}

}  // namespace

void bind_scenes(nb::module_& module) {
  module.def("linear_from_srgb", &linear_from_srgb);
  nb::class_<SharedFile>(module, "SceneFile")
      .def(nb::new_(&open), WholeCall())
      .def("at", &at, nb::arg("time").none(), WholeCall());
  nb::class_<Prepared>(module, "Prepared")
      .def("__init__", &prepare, nb::arg("scene"), nb::arg("previous").none(), nb::arg("threads"),
           nb::arg("fast_build"), WholeCall())
      .def_prop_ro("is_flat", [](const Prepared& self) { return self.is_flat; })
      .def_prop_ro(
          "has_bounded_object",
          [](const Prepared& self) {
            return result_unlocked([&] { return has_bounded_object(self.scene.scene()); });
          },
          WholeCall())
      .def_prop_ro("has_lights",
                   [](const Prepared& self) { return !self.scene.scene().lights.empty(); })
      .def_prop_ro("size",
                   [](const Prepared& self) {
                     const ImageSize size = self.scene.scene().size;
                     return nb::make_tuple(size.width, size.height);
                   })
      .def(
          "default_camera",
          [](const Prepared& self, std::array<std::uint32_t, 2> size) {
            return camera_to_python(
                default_camera(self.scene.scene(), {.width = size[0], .height = size[1]}), "");
          },
          WholeCall())
      .def(
          "scene",
          [](const Prepared& self) {
            return scene_to_python(self.scene.scene(), self.is_flat, self.has_background);
          },
          WholeCall());
}

}  // namespace microtrace::python
