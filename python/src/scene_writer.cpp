/// Converts a Scene to Python's dataclasses.

#include "scene_writer.hpp"

#include "arrays.hpp"
#include "fields.hpp"
#include "images.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <array>
#include <nanobind/stl/array.h>
#include <string>
#include <type_traits>
#include <unordered_map>
#include <vector>

namespace microtrace::python {
namespace {

nb::object wrapped(const char* function, auto data) {
  return member("images", function)(nb::cast(std::move(data)));
}

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene) {
    for (const auto& image : scene.images)
      images_.push_back(image ? wrapped("_image_of", SharedImage{image}) : nb::none());
    for (const Texture& texture : scene.textures) textures_.push_back(texture_of(texture));
    for (const Material& material : scene.materials) materials_.push_back(object_of(material));
  }

  nb::dict operator()(bool is_flat, bool has_background) {
    nb::list objects, materials, lights, cameras;
    for (const Object& object : scene_.objects) objects.append(object_of(object));
    for (const nb::object& material : materials_) materials.append(material);
    for (const NamedLight& light : scene_.lights) lights.append(light_of(light));
    for (const NamedCamera& camera : scene_.cameras)
      cameras.append(camera_to_python(camera.camera, camera.name));
    nb::dict result;
    result["objects"] = objects;
    result["materials"] = materials;
    result["lights"] = lights;
    result["cameras"] = cameras;
    result["environment"] = environment();
    result["background"] = has_background ? value(scene_.background) : nb::none();
    result["size"] = value(scene_.size);
    result["origin"] = value(scene_.origin);
    result["epsilon"] = scene_.epsilon;
    result["integrator"] = is_flat ? "flat" : "path";
    return result;
  }

  // One overload for each type of member.
  nb::object value(const std::string& v) { return nb::cast(v); }
  nb::object value(bool v) { return nb::cast(v); }
  nb::object value(double v) { return nb::cast(v); }
  nb::object value(float v) { return nb::cast(static_cast<double>(v)); }
  template <glm::length_t n, class Number>
  nb::object value(const glm::vec<n, Number>& v) {
    nb::list numbers;
    for (glm::length_t i = 0; i < n; ++i) numbers.append(static_cast<double>(v[i]));
    return nb::tuple(numbers);
  }
  template <class Enum>
  requires std::is_enum_v<Enum> nb::object value(Enum v) {
    return nb::cast(kNames<Enum>[static_cast<std::size_t>(v)]);
  }
  nb::object value(const ImageSize& v) { return nb::make_tuple(v.width, v.height); }
  nb::object value(const Distortion& v) {
    return std::visit([&](const auto& each) { return object_of(each); }, v);
  }
  nb::object value(const std::optional<double>& v) { return v ? nb::cast(*v) : nb::none(); }
  nb::object value(const std::optional<TextureUse>& v) { return v ? use_of(*v) : nb::none(); }
  template <class T>
  nb::object value(const Array<T>& v) {
    return to_python(v);
  }
  nb::object value(const ShortVector<Array<Vec2>>& v) {
    nb::list sets;
    for (const auto& set : v) sets.append(to_python(set));
    return nb::tuple(sets);
  }
  template <class T>
  nb::object value(const std::optional<T>& v) {
    return v ? object_of(*v) : nb::none();
  }

  template <class T>
  void add_fields(const T& from, nb::dict& to) {
    for_each_field(from, [&](const char* name, const auto& member) { to[name] = value(member); });
  }
  template <class T>
  nb::object object_of(const T& from) {
    nb::dict arguments;
    add_fields(from, arguments);
    return make(Class<T>::kModule, Class<T>::kName, arguments);
  }
  static nb::object make(const char* module, const char* name, const nb::dict& arguments) {
    return member(module, name)(**arguments);
  }

 private:
  nb::object use_of(const TextureUse& use) {
    const Mat3x2& m = use.texture_from_uv;
    nb::dict arguments;
    arguments["texture"] = textures_[use.texture];
    arguments["uv_set"] = use.uv_set;
    arguments["texture_from_uv"] = nb::make_tuple(value(Vec3(m[0][0], m[1][0], m[2][0])),
                                                  value(Vec3(m[0][1], m[1][1], m[2][1])));
    return make("materials", "TextureUse", arguments);
  }

  nb::object texture_of(const Texture& texture) {
    nb::dict arguments;
    arguments["image"] = texture.image ? images_[*texture.image] : nb::none();
    arguments["name"] = texture.name;
    arguments["wrap_s"] = value(texture.sampler.wrap_s);
    arguments["wrap_t"] = value(texture.sampler.wrap_t);
    arguments["magnification"] = value(texture.sampler.magnification);
    arguments["minification"] = value(texture.sampler.minification);
    arguments["mip"] = value(texture.sampler.mip);
    return make("materials", "Texture", arguments);
  }

  nb::object object_of(const Object& object) {
    nb::dict arguments;
    const auto* mesh = std::get_if<Mesh>(&object.shape);
    if (mesh != nullptr && mesh->placement) {
      arguments["shape"] = shared_mesh_of(*mesh);
      arguments["placement"] = matrix_of(*mesh->placement);
    } else {
      arguments["shape"] =
          std::visit([&](const auto& shape) { return shape_of(shape); }, object.shape);
    }
    arguments["material"] = object.material ? materials_[*object.material] : nb::none();
    arguments["name"] = object.name.str();
    return make("shapes", "Object", arguments);
  }

  template <class T>
  nb::object shape_of(const T& shape) {
    return object_of(shape);
  }
  nb::object shape_of(const Mesh& mesh) {
    nb::dict arguments;
    add_fields(mesh, arguments);
    arguments["vertices"] = rows_of(mesh.positions);  // required, even if there are none
    arguments["faces"] = rows_of(mesh.triangles);
    return make(Class<Mesh>::kModule, Class<Mesh>::kName, arguments);
  }
  nb::object shape_of(const Quadric& q) {
    nb::dict arguments;
    arguments["coefficients"] = nb::make_tuple(q.a, q.b, q.c, q.d, q.e, q.f, q.g, q.h, q.i, q.j);
    return make("shapes", "Quadric", arguments);
  }
  /// Returns one object for all meshes that share their arrays.
  nb::object shared_mesh_of(const Mesh& mesh) {
    const Mesh& first = shared_.find_or_add(mesh).mesh;
    nb::object& object = meshes_[&first];
    if (!object.is_valid()) object = shape_of(first);
    return object;
  }

  /// Returns the rows of a (3, 4) matrix.
  static nb::object matrix_of(const Placement& placement) {
    std::array<std::array<double, 4>, 3> rows;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 4; ++column)
        rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
            placement.column(column)[row];
    }
    return nb::cast(rows);
  }

  nb::object light_of(const NamedLight& light) {
    const nb::object result = std::visit([&](const auto& l) { return object_of(l); }, light.light);
    result.attr("name") = light.name;
    return result;
  }

  nb::object environment() {
    if (!scene_.environment) return nb::none();
    nb::dict arguments;
    arguments["content"] = std::visit(
        [&]<class T>(const T& content) -> nb::object {
          if constexpr (std::is_same_v<T, Vec3>)
            return value(content);
          else if constexpr (std::is_same_v<T, Studio>)
            return nb::cast("studio");
          else
            return wrapped("_map_of", SharedMap{content});
        },
        scene_.environment->content);
    arguments["rotation"] = scene_.environment->rotation;
    arguments["intensity"] = scene_.environment->intensity;
    arguments["is_background"] = scene_.environment->is_background;
    return make("lights", "Environment", arguments);
  }

  const Scene& scene_;
  std::vector<nb::object> images_, textures_, materials_;
  SharedMeshes shared_;
  std::unordered_map<const Mesh*, nb::object> meshes_;  // of shared_
};

}  // namespace

nb::dict scene_to_python(const Scene& scene, bool is_flat, bool has_background) {
  return Writer(scene)(is_flat, has_background);
}

nb::object camera_to_python(const Camera& camera, const std::string& name) {
  static const Scene kEmpty;
  Writer writer(kEmpty);
  return std::visit(
      [&]<class T>(const T& c) {
        nb::dict arguments;
        writer.add_fields(c, arguments);
        writer.add_fields(c.pose, arguments);
        if constexpr (requires { c.depth; }) writer.add_fields(c.depth, arguments);
        arguments["name"] = name;
        return Writer::make(Class<T>::kModule, Class<T>::kName, arguments);
      },
      camera);
}

}  // namespace microtrace::python
