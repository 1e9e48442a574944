/// Binds images and radiance maps. They are immutable and shared with prepared scenes.

#include "images.hpp"

#include "scene/math/srgb.hpp"

#include <cmath>
#include <cstring>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/vector.h>
#include <vector>

namespace microtrace::python {
namespace {

template <class T>
std::vector<T> values_of(const AnyArray& pixels) {
  const auto* data = static_cast<const T*>(pixels.data());
  return std::vector<T>(data, data + pixels.size());
}

/// Copies an image from a C-contiguous array of shape (height, width, channels).
std::shared_ptr<const Image> make_image(const AnyArray& pixels, std::string name) {
  auto image = std::make_shared<Image>();
  image->name = std::move(name);
  image->height = static_cast<std::uint32_t>(pixels.shape(0));
  image->width = static_cast<std::uint32_t>(pixels.shape(1));
  image->channels = static_cast<std::uint32_t>(pixels.shape(2));
  if (pixels.dtype() == nb::dtype<std::uint8_t>())
    image->samples = values_of<std::uint8_t>(pixels);
  else
    image->samples = values_of<std::uint16_t>(pixels);
  return image;
}

/// Copies a map from a C-contiguous float32 array of shape (height, width, 3).
std::shared_ptr<const RadianceMap> make_map(const AnyArray& pixels) {
  auto map = std::make_shared<RadianceMap>();
  map->height = static_cast<std::uint32_t>(pixels.shape(0));
  map->width = static_cast<std::uint32_t>(pixels.shape(1));
  map->pixels.resize(std::size_t{map->height} * map->width);
  std::memcpy(map->pixels.data(), pixels.data(), map->pixels.size() * sizeof(Vec3));
  for (Vec3& pixel : map->pixels) {
    for (glm::length_t i = 0; i < 3; ++i)
      if (!(pixel[i] >= 0) || pixel[i] > kMaxRadiance)
        throw Error(ErrorKind::invalid_scene, "RadianceMap", "pixels must be in [0, 1e9]");
  }
  return map;
}

template <class Owner, class T>
nb::object view(const Owner& owner, const T* data, std::initializer_list<std::size_t> shape) {
  auto* keeper = new Owner(owner);
  const nb::capsule capsule(keeper, [](void* p) noexcept { delete static_cast<Owner*>(p); });
  return nb::cast(nb::ndarray<nb::numpy, const T>(data, shape, capsule));
}

nb::object pixels_of(const SharedImage& shared) {
  const auto& image = shared.image;
  return std::visit(
      [&](const auto& samples) {
        return view(image, samples.data(), {image->height, image->width, image->channels});
      },
      image->samples);
}

nb::object pixels_of_map(const SharedMap& shared) {
  return view(shared.map, &shared.map->pixels.data()->x,
              {shared.map->height, shared.map->width, std::size_t{3}});
}

}  // namespace

void bind_images(nb::module_& module) {
  nb::class_<SharedImage>(module, "ImageData")
      .def(
          "__init__",
          [](SharedImage* self, const AnyArray& pixels, std::string name) {
            new (self) SharedImage{make_image(pixels, std::move(name))};
          },
          WholeCall())
      .def_prop_ro("name", [](const SharedImage& self) { return self.image->name; })
      .def_prop_ro("pixels", pixels_of, WholeCall());
  nb::class_<SharedMap>(module, "MapData")
      .def(
          "__init__",
          [](SharedMap* self, const AnyArray& pixels) { new (self) SharedMap{make_map(pixels)}; },
          WholeCall())
      .def_prop_ro("pixels", pixels_of_map, WholeCall());
  module.def(
      "load_map",
      [](const std::filesystem::path& path) {
        LoadedRadianceMap loaded = result_unlocked([&] { return load_radiance_map(path); });
        return nb::make_tuple(SharedMap{std::move(loaded.map)}, to_python(loaded.warnings));
      },
      WholeCall());
}

}  // namespace microtrace::python
