/// Converts Python's dataclasses to a Scene.

#include "scene_reader.hpp"

#include "arrays.hpp"
#include "fields.hpp"
#include "images.hpp"
#include "member_names.hpp"
#include "scene/validate/check_indices.hpp"
#include "scene/validate/validate.hpp"
#include "values.hpp"

#include <memory>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <string>
#include <unordered_map>
#include <variant>
#include <vector>

#include <glm/geometric.hpp>

namespace microtrace::python {
namespace {

template <class Enum>
Enum named(const std::string& name, const char* what) {
  std::string all;
  for (std::size_t i = 0; i < kNames<Enum>.size(); ++i) {
    if (name == kNames<Enum>[i]) return static_cast<Enum>(i);
    all.append(i > 0 ? ", " : "").append(kNames<Enum>[i]);
  }
  throw nb::value_error((std::string(what) + " must be one of " + all + ", not " + name).c_str());
}

/// Assigns consecutive indices, called places, to Python objects.
class Places {
 public:
  /// Returns the object's place. If the object is new, calls add(), which appends the object to its
  /// list.
  template <class F>
  std::uint32_t of(const nb::handle& item, const F& add) {
    const auto [at, is_new] = places_.try_emplace(item.ptr(), next_);
    if (is_new) append(item, add);
    return at->second;
  }

  /// Appends an object of a list. If it has a place already, it keeps that place, but the objects
  /// after it get those of the list.
  template <class F>
  void add(const nb::handle& item, const F& add) {
    places_.try_emplace(item.ptr(), next_);
    append(item, add);
  }

 private:
  template <class F>
  void append(const nb::handle& item, const F& add) {
    kept_.push_back(nb::borrow(item));  // keeps other objects from getting its address
    ++next_;
    add();
  }

  std::uint32_t next_ = 0;
  std::unordered_map<PyObject*, std::uint32_t> places_;
  std::vector<nb::object> kept_;
};

class Reader {
 public:
  explicit Reader(const nb::handle& source) : source_(source) {}

  Scene operator()() {
    read_field("origin", scene_.origin);
    read_field("epsilon", scene_.epsilon);
    if (!source_.attr("background").is_none()) read_field("background", scene_.background);
    read_field("size", scene_.size);
    for (const nb::handle material : list_of(source_.attr("materials"), "materials", "a list"))
      materials_.add(material, [&] { read_material(material); });
    for (const nb::handle object : list_of(source_.attr("objects"), "objects", "a list"))
      add_object(object);
    for (const nb::handle light : list_of(source_.attr("lights"), "lights", "a list"))
      add_light(light);
    for (const nb::handle camera : list_of(source_.attr("cameras"), "cameras", "a list")) {
      const Camera made = camera_of(camera);
      scene_.cameras.push_back({.name = text(camera, "name"), .camera = made});
    }
    scene_.environment = environment_of(source_.attr("environment"));
    return std::move(scene_);
  }

 private:
  static std::string text(const nb::handle& object, const char* name) {
    return cast<std::string>(object.attr(name), name);
  }

  // One overload for each type of member.
  void read(const nb::handle& value, std::string& to) { to = cast<std::string>(value, field_); }
  void read(const nb::handle& value, bool& to) { to = cast<bool>(value, field_); }
  void read(const nb::handle& value, double& to) { to = cast<double>(value, field_); }
  void read(const nb::handle& value, float& to) {
    to = static_cast<float>(cast<double>(value, field_));
  }
  template <glm::length_t n, class Number>
  void read(const nb::handle& value, glm::vec<n, Number>& to) {
    const nb::list items = list_of(value, field_, std::to_string(n) + " numbers");
    if (items.size() != static_cast<std::size_t>(n))
      throw nb::value_error((std::string(field_) + " must have " + std::to_string(n) +
                             " numbers, not " + std::to_string(items.size()))
                                .c_str());
    for (glm::length_t k = 0; k < n; ++k)
      to[k] = static_cast<Number>(cast<double>(items[static_cast<std::size_t>(k)], field_));
  }
  void read(const nb::handle& value, AlphaMode& to) {
    to = named<AlphaMode>(cast<std::string>(value, field_), field_);
  }
  void read(const nb::handle& value, ImageSize& to) {
    const auto [width, height] = cast<std::array<std::uint32_t, 2>>(value, field_);
    to = {.width = width, .height = height};
  }
  void read(const nb::handle& value, Distortion& to) {
    if (is<FisheyeDistortion>(value))
      to = fields_of<FisheyeDistortion>(value);
    else if (is<RationalDistortion>(value))
      to = fields_of<RationalDistortion>(value);
    else
      wrong("a distortion", value);
  }
  void read(const nb::handle& value, std::optional<double>& to) {
    if (!value.is_none()) to = cast<double>(value, field_);
  }
  void read(const nb::handle& value, std::optional<TextureUse>& to) {
    if (!value.is_none()) to = texture_use_of(value);
  }
  template <class T>
  void read(const nb::handle& value, Array<T>& to) {
    if (!value.is_none()) to = rows_of<T>(value, field_);
  }
  void read(const nb::handle& value, ShortVector<Array<Vec2>>& to) {
    for (const nb::handle set : list_of(value, field_, "a list"))
      to.push_back(set.is_none() ? Array<Vec2>() : rows_of<Vec2>(set, "each set of uv"));
  }
  template <class T>
  void read(const nb::handle& value, std::optional<T>& to) {
    if (value.is_none()) return;
    if (!is<T>(value)) refuse(field_, std::string("a microtrace.") + Class<T>::kName, value);
    read_fields(value, to.emplace());
  }

  template <class T>
  void read_field(const char* name, T& to) {
    field_ = name;
    read(source_.attr(name), to);
  }
  template <class T>
  void read_fields(const nb::handle& object, T& to) {
    for_each_field(to, [&](const char* name, auto& member) {
      field_ = name;
      read(object.attr(name), member);
    });
  }
  template <class T>
  T fields_of(const nb::handle& object) {
    T result{};
    read_fields(object, result);
    return result;
  }

  static bool is(const nb::handle& object, const char* module, const char* name) {
    return nb::isinstance(object, member(module, name));
  }
  template <class T>
  static bool is(const nb::handle& object) {
    return is(object, Class<T>::kModule, Class<T>::kName);
  }

  std::uint32_t place_of_material(const nb::handle& material) {
    return materials_.of(material, [&] { read_material(material); });
  }

  void read_material(const nb::handle& material) {
    if (!is<Material>(material)) wrong("a material", material);
    scene_.materials.push_back(fields_of<Material>(material));
  }

  TextureUse texture_use_of(const nb::handle& value) {
    TextureUse result;
    if (!is(value, "materials", "TextureUse")) {
      result.texture = place_of_texture(value);
      return result;
    }
    result.texture = place_of_texture(value.attr("texture"));
    result.uv_set = cast<std::uint32_t>(value.attr("uv_set"), "uv_set");
    const auto rows = cast<std::array<std::array<double, 3>, 2>>(value.attr("texture_from_uv"),
                                                                 "texture_from_uv");
    for (glm::length_t row = 0; row < 2; ++row)
      for (glm::length_t column = 0; column < 3; ++column)
        result.texture_from_uv[column][row] = static_cast<float>(
            rows[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)]);
    return result;
  }

  /// Returns the place of a texture. `value` is a Texture, an Image, or an array of pixels.
  std::uint32_t place_of_texture(const nb::handle& value) {
    return textures_.of(value, [&] {
      Texture texture;
      if (is(value, "materials", "Texture")) {
        texture.name = text(value, "name");
        texture.sampler = {
            .wrap_s = named<Wrap>(text(value, "wrap_s"), "wrap_s"),
            .wrap_t = named<Wrap>(text(value, "wrap_t"), "wrap_t"),
            .magnification = named<Filter>(text(value, "magnification"), "magnification"),
            .minification = named<Filter>(text(value, "minification"), "minification"),
            .mip = named<MipFilter>(text(value, "mip"), "mip")};
        if (const nb::object image = value.attr("image"); !image.is_none())
          texture.image = place_of_image(image);
      } else {
        texture.image = place_of_image(value);
      }
      scene_.textures.push_back(std::move(texture));
    });
  }

  std::uint32_t place_of_image(const nb::handle& value) {
    return images_.of(value, [&] {
      const nb::object make = member("images", "Image");
      const nb::object image = nb::isinstance(value, make) ? nb::borrow(value) : make(value);
      scene_.images.push_back(nb::cast<const SharedImage&>(image.attr("_data")).image);
    });
  }

  template <class T>
  static Array<T> rows_of(const nb::handle& values, const char* name) {
    using Number = typename Array<T>::Number;
    const char* check = std::is_floating_point_v<Number> ? "as_rows" : "as_indices";
    const nb::object rows = member("_arrays", check)(values, name, sizeof(T) / sizeof(Number));
    return to_array<T>(nb::cast<AnyArray>(rows));
  }

  /// Returns a mesh whose arrays are shared by all objects with the same Python object.
  Mesh mesh_of(const nb::handle& mesh) {
    return meshes_[places_of_meshes_.of(mesh, [&] {
      refuse_encoded_colors(mesh.attr("colors"));
      meshes_.push_back(fields_of<Mesh>(mesh));
    })];
  }

  /// Refuses 8-bit integers, which would be taken for linear numbers from 0 to 255.
  static void refuse_encoded_colors(const nb::object& colors) {
    if (!nb::hasattr(colors, "dtype")) return;
    if (!nb::str(colors.attr("dtype")).equal(nb::str("uint8"))) return;
    throw nb::value_error(
        "colors must be linear numbers; Scene.add_mesh converts 8-bit sRGB integers");
  }

  static std::shared_ptr<const Placement> placement_of(const nb::handle& value) {
    const auto numbers = nb::cast<std::array<double, 16>>(
        nb::tuple(nb::borrow<nb::object>(member("_arrays", "as_affine")(value, "placement"))));
    DMat4 matrix;
    for (int i = 0; i < 16; ++i) matrix[i / 4][i % 4] = numbers[static_cast<std::size_t>(i)];
    return std::make_shared<const Placement>(matrix);
  }

  Shape shape_of(const nb::handle& shape) {
    if (is<Mesh>(shape)) return mesh_of(shape);
    if (is<Sphere>(shape)) return fields_of<Sphere>(shape);
    if (is<Plane>(shape)) return fields_of<Plane>(shape);
    if (is<Disc>(shape)) return fields_of<Disc>(shape);
    if (is<Triangle>(shape)) return fields_of<Triangle>(shape);
    if (!is(shape, "shapes", "Quadric")) wrong("a shape", shape);
    const auto c = cast<std::array<double, 10>>(
        list_of(shape.attr("coefficients"), "coefficients", kWords<std::array<double, 10>>),
        "coefficients");
    const auto f = [&](std::size_t i) { return static_cast<float>(c[i]); };
    return Quadric{f(0), f(1), f(2), f(3), f(4), f(5), f(6), f(7), f(8), f(9)};
  }

  void add_object(const nb::handle& object) {
    if (!is(object, "shapes", "Object")) wrong("an Object", object);
    Object result{.name = text(object, "name"), .shape = shape_of(object.attr("shape"))};
    if (const nb::object material = object.attr("material"); !material.is_none())
      result.material = place_of_material(material);
    if (const nb::object placement = object.attr("placement"); !placement.is_none()) {
      auto* const mesh = std::get_if<Mesh>(&result.shape);
      if (mesh == nullptr) throw nb::value_error("only meshes can have a placement");
      if (!mesh->segments.empty())
        throw nb::value_error("meshes with segments can't have a placement");
      mesh->placement = placement_of(placement);
    }
    scene_.objects.push_back(std::move(result));
  }

  void add_light(const nb::handle& light) {
    const auto add = [&](auto made) {
      if constexpr (requires { made.direction; }) made.direction = unit(made.direction);
      scene_.lights.push_back({.name = text(light, "name"), .light = made});
    };
    if (is<DirectionalLight>(light)) return add(fields_of<DirectionalLight>(light));
    if (is<PointLight>(light)) return add(fields_of<PointLight>(light));
    if (is<SpotLight>(light)) return add(fields_of<SpotLight>(light));
    wrong("a light", light);
  }

  static DVec3 unit(const DVec3& v) {
    const double length = glm::length(v);
    if (!(length > 0 && length <= std::numeric_limits<double>::max()))
      throw nb::value_error("a light's direction must be finite and not zero");
    return v / length;
  }

  [[noreturn]] static void wrong(const char* what, const nb::handle& object) {
    throw nb::type_error(
        (std::string("expected ") + what + ", not " + nb::repr(object.type()).c_str()).c_str());
  }

  template <class T>
  Camera posed(const nb::handle& camera) {
    auto result = fields_of<T>(camera);
    read_fields(camera, result.pose);
    if constexpr (requires { result.depth; }) read_fields(camera, result.depth);
    return result;
  }

  friend Camera microtrace::python::camera_from_python(const nb::handle& camera);
  Camera camera_of(const nb::handle& camera) {
    if (is<PerspectiveCamera>(camera)) return posed<PerspectiveCamera>(camera);
    if (is<OrthographicCamera>(camera)) return posed<OrthographicCamera>(camera);
    if (is<CalibratedCamera>(camera)) return posed<CalibratedCamera>(camera);
    if (is<EnvironmentCamera>(camera)) return posed<EnvironmentCamera>(camera);
    wrong("a camera", camera);
  }

  static constexpr const char* kContents = "\"studio\", a color or a microtrace.RadianceMap";
  [[noreturn]] static void refuse_content() {
    throw nb::value_error((std::string("content must be ") + kContents).c_str());
  }

  friend std::optional<Environment> microtrace::python::environment_from_python(
      const nb::handle& environment);
  std::optional<Environment> environment_of(const nb::handle& environment) {
    if (environment.is_none()) return std::nullopt;
    if (!is(environment, "lights", "Environment")) wrong("an Environment", environment);
    Environment result;
    result.rotation = cast<double>(environment.attr("rotation"), "rotation");
    result.intensity = cast<float>(environment.attr("intensity"), "intensity");
    result.is_background = cast<bool>(environment.attr("is_background"), "is_background");
    const nb::object content = environment.attr("content");
    if (is(content, "images", "RadianceMap")) {
      result.content = nb::cast<const SharedMap&>(content.attr("_data")).map;
    } else if (nb::isinstance<nb::str>(content)) {
      if (cast<std::string>(content, "content") != "studio") refuse_content();
      result.content = Studio{};
    } else {
      const nb::list color = list_of(content, "content", kContents);
      if (color.size() != 3) refuse_content();
      Vec3 radiance;
      field_ = "content";
      read(color, radiance);
      result.content = radiance;
    }
    return result;
  }

  nb::handle source_;
  Scene scene_;
  Places materials_, textures_, images_, places_of_meshes_;
  std::vector<Mesh> meshes_;
  const char* field_ = "";  // the field being read, for messages
};

}  // namespace

Scene scene_from_python(const nb::handle& scene) {
  return Reader(scene)();
}

Camera camera_from_python(const nb::handle& camera) {
  Camera result = Reader(camera).camera_of(camera);
  with_python_names([&] {
    if (const auto broken = validate(result)) {
      throw Error(broken->kind, {.file = {},
                                 .pointer = "/camera/" + broken->field,
                                 .message = broken->message,
                                 .excerpt = {}});
    }
  });
  return result;
}

std::optional<Environment> environment_from_python(const nb::handle& environment) {
  std::optional<Environment> result = Reader(environment).environment_of(environment);
  if (!result) return result;
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&result->content);
  check_environment(*result, map != nullptr ? map->get() : nullptr);  // a SharedMap is valid
  return result;
}

}  // namespace microtrace::python
