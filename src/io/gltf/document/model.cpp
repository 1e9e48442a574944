#include "io/gltf/document/model.hpp"

#include "base/memory_account.hpp"
#include "base/system/mapped_pages.hpp"
#include "io/gltf/document/model_json.hpp"
#include "io/gltf/document/properties.hpp"
#include "io/json/write.hpp"

#include <microtrace/material.hpp>

#include <algorithm>
#include <array>
#include <fstream>  // for tinygltf 2.7.0
#include <limits>
#include <string>
#include <string_view>
#include <utility>

// The parser is compiled here, without its access to files and images. A program that links this
// library may contain another version of tinygltf, so its namespace gets another name.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_FS
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define tinygltf microtrace_tinygltf
#include <tiny_gltf.h>

namespace microtrace::io::gltf {
namespace {

/// Members of the root object that tinygltf parses. None of them contains URIs or images. There may
/// be millions of nodes, which would take a kilobyte each, so they are read from the JSON.
constexpr std::array<std::string_view, 6> kParsedMembers = {"asset",  "scene",     "scenes",
                                                            "meshes", "accessors", "bufferViews"};

/// Members omitted from the text that tinygltf parses. Indices, sparse parts and strides are read
/// from the JSON instead, because tinygltf 2.7.0 rejects index accessors without a buffer view,
/// which glTF allows, stores sparse offsets as int, and rejects assets with wrong strides.
constexpr std::array<std::string_view, 5> kLeftOut = {"extensions", "extras", "indices", "sparse",
                                                      "byteStride"};

/// Members of nodes that only the model needs. They are most of the JSON of an asset with millions
/// of nodes.
constexpr std::array<std::string_view, 7> kReadOfNodes = {
    "children", "matrix", "mesh", "name", "rotation", "scale", "translation"};

/// Returns true if check_schema has removed the type of an accessor because it was unknown.
bool is_unknown(const JsonValue& accessor) {
  return accessor.find("type") == nullptr || accessor.find("componentType") == nullptr;
}

/// Returns the part of the repaired JSON that tinygltf parses, as text.
std::string parsed_part(const JsonValue& root) {
  std::string text = "{";
  const auto separate = [&text] {
    if (text.back() != '{' && text.back() != '[') text += ',';
  };
  for (const JsonMember& member : root.members()) {
    if (std::ranges::find(kParsedMembers, member.key) == kParsedMembers.end()) continue;
    separate();
    append_json(text, member.key);
    text += ':';
    if (member.key != "accessors") {
      append_json(text, member.value, kLeftOut);
      continue;
    }
    text += '[';
    for (const JsonValue& accessor : member.value.items()) {
      separate();
      if (is_unknown(accessor)) {  // otherwise tinygltf would reject the whole asset
        text += R"({"type":"SCALAR","componentType":5121,"count":1})";
      } else {
        append_json(text, accessor, kLeftOut);
      }
    }
    text += ']';
  }
  return text + '}';
}

tinygltf::Model parse(const Asset& asset) {
  const std::string text = parsed_part(*asset.root().value);
  if (text.size() > std::numeric_limits<unsigned>::max()) {
    asset.fail(asset.root(), "has more JSON than tinygltf can read (4 GiB); split the file",
               ErrorKind::limit);
  }
  tinygltf::Model model;
  std::string error, warning;
  const bool parsed_whole = tinygltf::TinyGLTF().LoadASCIIFromString(
      &model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), "",
      tinygltf::NO_REQUIRE);
  if (!parsed_whole || !error.empty()) {
    while (error.ends_with('\n')) error.pop_back();
    asset.fail(asset.root(), "tinygltf can't read the asset: " + error);
  }
  return model;
}

/// Converts an index of tinygltf, which uses -1 for an absent index.
std::optional<std::size_t> optional_index(int index) {
  return index >= 0 ? std::optional(static_cast<std::size_t>(index)) : std::nullopt;
}

std::vector<std::size_t> indices_of(const std::vector<int>& indices) {
  return {indices.begin(), indices.end()};
}

ElementType type_of(int tinygltf_type) {
  switch (tinygltf_type) {
    case TINYGLTF_TYPE_SCALAR:
      return ElementType::scalar;
    case TINYGLTF_TYPE_VEC2:
      return ElementType::vec2;
    case TINYGLTF_TYPE_VEC3:
      return ElementType::vec3;
    case TINYGLTF_TYPE_VEC4:
      return ElementType::vec4;
    case TINYGLTF_TYPE_MAT2:
      return ElementType::mat2;
    case TINYGLTF_TYPE_MAT3:
      return ElementType::mat3;
    default:
      return ElementType::mat4;
  }
}

Model::Sparse sparse_of(const JsonValue& json) {
  const JsonValue &indices = *json.find("indices"), &values = *json.find("values");
  return {.count = index_from(*json.find("count")),
          .indices_view = index_from(*indices.find("bufferView")),
          .indices_offset = index_in(indices, "byteOffset").value_or(0),
          .index_type = static_cast<int>(indices.find("componentType")->number()),
          .values_view = index_from(*values.find("bufferView")),
          .values_offset = index_in(values, "byteOffset").value_or(0)};
}

Model::Accessor accessor_of(const tinygltf::Accessor& accessor, const JsonValue& json) {
  if (is_unknown(json)) return {};
  if (json.find("count")->number() == 0) {
    return {
        .type = type_of(accessor.type), .component_type = accessor.componentType, .is_empty = true};
  }
  Model::Accessor result{.type = type_of(accessor.type),
                         .component_type = accessor.componentType,
                         .normalized = accessor.normalized,
                         .count = accessor.count,
                         .view = optional_index(accessor.bufferView),
                         .offset = accessor.byteOffset};
  if (const JsonValue* sparse = json.find("sparse")) result.sparse = sparse_of(*sparse);
  return result;
}

Model::Attributes attributes_of(const std::map<std::string, int>& attributes) {
  Model::Attributes result;
  for (const auto& [name, accessor] : attributes) {
    result.emplace_hint(result.end(), name, static_cast<std::size_t>(accessor));
  }
  return result;
}

Model::Primitive primitive_of(const tinygltf::Primitive& primitive, const JsonValue& json) {
  Model::Primitive result{.attributes = attributes_of(primitive.attributes),
                          .indices = index_in(json, "indices"),
                          .material = optional_index(primitive.material),
                          .mode = static_cast<Model::Mode>(primitive.mode)};
  for (const auto& target : primitive.targets) result.targets.push_back(attributes_of(target));
  return result;
}

Model::Mesh mesh_of(tinygltf::Mesh& mesh, const JsonValue& json) {
  Model::Mesh result{.name = std::move(mesh.name), .weights = std::move(mesh.weights)};
  const std::vector<JsonValue>& primitives = json.find("primitives")->items();
  result.primitives.reserve(primitives.size());
  for (std::size_t i = 0; i < primitives.size(); ++i) {
    result.primitives.push_back(primitive_of(mesh.primitives[i], primitives[i]));
  }
  return result;
}

std::size_t count_values(const JsonValue& value) {
  std::size_t result = 1;
  for (const JsonValue& item : value.items()) result += count_values(item);
  for (const JsonMember& member : value.members()) result += count_values(member.value);
  return result;
}

/// The estimated size of an item's small members.
constexpr std::size_t kParts = 128;

void count(std::size_t items, std::size_t bytes) {
  take_memory(items * bytes, "the asset's model");
}

/// Makes the model's nodes, and removes what they contain from the JSON, whose memory returns to
/// the system meanwhile.
std::vector<Model::Node> take_nodes(Asset& asset) {
  constexpr std::size_t kNodesPerTrim = std::size_t{1} << 15U;
  const std::vector<JsonValue>& nodes = asset.array("nodes");
  std::vector<Model::Node> result;
  result.reserve(nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (i % kNodesPerTrim == 0) {
      if (i > 0) trim_heap();
      count(std::min(nodes.size() - i, kNodesPerTrim), sizeof(Model::Node) + kParts);
    }
    result.push_back(node_of(nodes[i]));
    asset.forget("nodes", i, kReadOfNodes);
  }
  return result;
}

/// Counts the memory of the model without its nodes, which is estimated from the number of items in
/// the asset's arrays.
void count_model(const Asset& asset) {
  count(asset.array("meshes").size(), sizeof(Model::Mesh) + kParts);
  count(asset.array("accessors").size(), sizeof(Model::Accessor));
  count(asset.array("bufferViews").size(), sizeof(Model::BufferView));
  // The scene gets copies of the model's materials.
  count(asset.array("materials").size(), 2 * sizeof(Material) + kParts);
  count(asset.array("scenes").size(), kParts);
  for (const JsonValue& mesh : asset.array("meshes")) {
    const JsonValue* primitives = mesh.find("primitives");
    if (primitives == nullptr) continue;
    count(primitives->items().size(), sizeof(Model::Primitive) + 3 * kParts);
  }
}

}  // namespace

Model parse_model(Asset& asset) {
  count_model(asset);
  Model model{.nodes = take_nodes(asset)};
  // Estimated memory for the text, for tinygltf's own JSON tree, and for tinygltf's result.
  constexpr std::size_t kBytesOfValue = 160, kBytesOfItem = 512;
  std::size_t work_bytes = 0;
  for (const std::string_view name : kParsedMembers) {
    const JsonValue* const parsed = asset.root().value->find(name);
    if (parsed == nullptr) continue;
    work_bytes += count_values(*parsed) * kBytesOfValue + parsed->items().size() * kBytesOfItem;
  }
  const MemoryAccount work = temporary_memory(work_bytes, "reading the asset's JSON");
  tinygltf::Model parsed = parse(asset);
  const std::vector<JsonValue>&views = asset.array("bufferViews"),
        &accessors = asset.array("accessors"), &meshes = asset.array("meshes");
  for (std::size_t i = 0; i < views.size(); ++i) {
    const tinygltf::BufferView& view = parsed.bufferViews[i];
    model.buffer_views.push_back({.buffer = static_cast<std::size_t>(view.buffer),
                                  .offset = view.byteOffset,
                                  .length = view.byteLength,
                                  .stride = index_in(views[i], "byteStride").value_or(0)});
  }
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    model.accessors.push_back(accessor_of(parsed.accessors[i], accessors[i]));
  }
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    model.meshes.push_back(mesh_of(parsed.meshes[i], meshes[i]));
  }
  for (const JsonValue& skin : asset.array("skins")) model.skins.push_back(skin_of(skin));
  for (const tinygltf::Scene& scene : parsed.scenes) {
    model.scenes.push_back(indices_of(scene.nodes));
  }
  model.scene = optional_index(parsed.defaultScene).value_or(0);
  return model;
}

}  // namespace microtrace::io::gltf
