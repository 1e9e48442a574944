#include "io/gltf/document/model_json.hpp"

#include "io/gltf/document/properties.hpp"

#include <memory>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

namespace microtrace::io::gltf {
namespace {

std::vector<std::size_t> indices_of(const JsonValue& array) {
  std::vector<std::size_t> result;
  for (const JsonValue& item : array.items()) result.push_back(index_from(item));
  return result;
}

/// Returns the numbers of an optional array. Empty if it is absent.
std::vector<double> numbers_in(const JsonValue& object, std::string_view key) {
  std::vector<double> result;
  if (const JsonValue* value = object.find(key)) {
    for (const JsonValue& item : value->items()) result.push_back(item.number());
  }
  return result;
}

DVec3 vector_in(const JsonValue& object, std::string_view key, const DVec3& standard) {
  const std::vector<double> v = numbers_in(object, key);
  return v.empty() ? standard : DVec3(v[0], v[1], v[2]);
}

}  // namespace

Model::Node node_of(const JsonValue& json) {
  Model::Node result{.mesh = index_in(json, "mesh"),
                     .skin = index_in(json, "skin"),
                     .camera = index_in(json, "camera"),
                     .weights = numbers_in(json, "weights"),
                     .has_extensions = json.find("extensions") != nullptr};
  if (const JsonValue* name = json.find("name")) result.name = name->string();
  if (const JsonValue* children = json.find("children")) result.children = indices_of(*children);
  if (const std::vector<double> m = numbers_in(json, "matrix"); !m.empty()) {
    result.matrix = std::make_shared<const DMat4>(glm::make_mat4(m.data()));
  }
  result.translation = vector_in(json, "translation", result.translation);
  result.scale = vector_in(json, "scale", result.scale);
  if (const std::vector<double> q = numbers_in(json, "rotation"); !q.empty()) {
    result.rotation = {q[0], q[1], q[2], q[3]};
  }
  return result;
}

Model::Skin skin_of(const JsonValue& json) {
  return {.joints = indices_of(*json.find("joints")),
          .inverse_bind_matrices = index_in(json, "inverseBindMatrices")};
}

}  // namespace microtrace::io::gltf
