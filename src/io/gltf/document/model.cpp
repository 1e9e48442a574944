#include "io/gltf/document/model.hpp"

#include "base/memory_account.hpp"

#include <microtrace/material.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include <nlohmann/json.hpp>

namespace microtrace::io::gltf {
namespace {

constexpr std::array<std::string_view, 10> parsed = {
    "asset",  "extensionsUsed", "scene",       "scenes",    "nodes",
    "meshes", "accessors",      "bufferViews", "materials", "cameras"};

// tinygltf 2.7.0 refuses an index accessor without a buffer view, which glTF allows. So indices
// travel as an attribute; check_schema admits no attribute of this name.
constexpr const char* indices_name = "INDICES";

nlohmann::json copy_of(const JsonValue& value) {
  switch (value.kind) {
    case JsonValue::Kind::null:
      return nullptr;
    case JsonValue::Kind::boolean:
      return value.boolean;
    case JsonValue::Kind::string:
      return value.string;
    case JsonValue::Kind::number: {
      // tinygltf takes 3.0 for no integer; glTF takes it for one.
      const bool integer = std::trunc(value.number) == value.number &&
                           std::abs(value.number) <= 0x1p53 && !std::signbit(value.number);
      if (integer) return static_cast<std::int64_t>(value.number);
      return value.number;
    }
    case JsonValue::Kind::array: {
      nlohmann::json copy = nlohmann::json::array();
      for (const JsonValue& item : value.items) copy.push_back(copy_of(item));
      return copy;
    }
    case JsonValue::Kind::object: {
      nlohmann::json copy = nlohmann::json::object();
      for (const JsonMember& member : value.members) {
        if (member.key != "extensions" && member.key != "extras") {
          copy[member.key] = copy_of(member.value);
        }
      }
      return copy;
    }
  }
  return nullptr;
}

/// tinygltf refuses an asset for what check_schema survives: an accessor of unknown type, which no
/// part of a mesh may then use, and a camera of unknown type, which no node then names.
void fill_in(nlohmann::json& asset) {
  for (nlohmann::json& accessor : asset["accessors"]) {
    if (accessor.contains("type") && accessor.contains("componentType")) continue;
    accessor = {{"type", "SCALAR"}, {"componentType", 5121}, {"count", 1}};
  }
  for (nlohmann::json& camera : asset["cameras"]) {
    if (camera.contains("type")) continue;
    camera = {{"type", "perspective"}, {"perspective", {{"yfov", 1}, {"znear", 1}}}};
  }
}

nlohmann::json parsed_part(const JsonValue& root) {
  nlohmann::json result = nlohmann::json::object();
  for (const JsonMember& member : root.members) {
    if (std::ranges::find(parsed, member.key) == parsed.end()) continue;
    result[member.key] = copy_of(member.value);
  }
  fill_in(result);
  if (!result.contains("meshes")) return result;
  for (nlohmann::json& mesh : result["meshes"]) {
    for (nlohmann::json& primitive : mesh["primitives"]) {
      const auto indices = primitive.find("indices");
      if (indices == primitive.end()) continue;
      primitive["attributes"][indices_name] = *indices;
      primitive.erase("indices");
    }
  }
  return result;
}

void restore_indices(tinygltf::Model& model) {
  for (tinygltf::Mesh& mesh : model.meshes) {
    for (tinygltf::Primitive& primitive : mesh.primitives) {
      const auto indices = primitive.attributes.find(indices_name);
      if (indices == primitive.attributes.end()) continue;
      primitive.indices = indices->second;
      primitive.attributes.erase(indices);
    }
  }
}

/// tinygltf without access to files and without an image decoder.
tinygltf::TinyGLTF make_parser() {
  tinygltf::TinyGLTF parser;
  tinygltf::FsCallbacks none{};
  none.FileExists = [](const std::string&, void*) { return false; };
  none.ExpandFilePath = [](const std::string& path, void*) { return path; };
  none.ReadWholeFile = [](std::vector<unsigned char>*, std::string*, const std::string&, void*) {
    return false;
  };
  none.WriteWholeFile = [](std::string*, const std::string&, const std::vector<unsigned char>&,
                           void*) { return false; };
  parser.SetFsCallbacks(none);
  parser.SetImageLoader([](tinygltf::Image*, int, std::string*, std::string*, int, int,
                           const unsigned char*, int, void*) { return true; },
                        nullptr);
  return parser;
}

std::size_t count_values(const JsonValue& value) {
  std::size_t result = 1;
  for (const JsonValue& item : value.items) result += count_values(item);
  for (const JsonMember& member : value.members) result += count_values(member.value);
  return result;
}

/// What the model holds for each item of the asset's arrays, but for its small parts.
void count_model(const Asset& asset) {
  const auto count = [&](const char* array, std::size_t bytes) {
    take_memory(asset.array(array).size() * bytes, "the asset's model");
  };
  constexpr std::size_t parts = 256;
  count("nodes", sizeof(tinygltf::Node) + parts);
  count("meshes", sizeof(tinygltf::Mesh) + parts);
  count("accessors", sizeof(tinygltf::Accessor) + parts);
  count("bufferViews", sizeof(tinygltf::BufferView));
  count("materials", sizeof(tinygltf::Material) + 8 * parts + sizeof(Material));
  count("cameras", sizeof(tinygltf::Camera) + parts);
  count("scenes", sizeof(tinygltf::Scene) + parts);
  for (const JsonValue& mesh : asset.array("meshes")) {
    const JsonValue* primitives = mesh.find("primitives");
    if (primitives == nullptr) continue;
    take_memory(primitives->items.size() * (sizeof(tinygltf::Primitive) + parts),
                "the asset's model");
  }
}

}  // namespace

tinygltf::Model parse_model(const Asset& asset) {
  // The JSON that tinygltf parses, and what it parses it to.
  constexpr std::size_t bytes_of_value = 160;
  const MemoryAccount work = temporary_memory(count_values(*asset.root().value) * bytes_of_value,
                                              "reading the asset's JSON");
  count_model(asset);
  const std::string text = parsed_part(*asset.root().value).dump();
  if (text.size() > std::numeric_limits<unsigned>::max()) {
    asset.fail(asset.root(), "has more JSON than tinygltf can take (4 GiB); split the file",
               ErrorKind::limit);
  }
  tinygltf::Model model;
  std::string error, warning;
  const bool parsed_whole = make_parser().LoadASCIIFromString(&model, &error, &warning, text.data(),
                                                              static_cast<unsigned>(text.size()),
                                                              "", tinygltf::NO_REQUIRE);
  if (!parsed_whole || !error.empty()) {
    while (error.ends_with('\n')) error.pop_back();
    asset.fail(asset.root(), "tinygltf can't read the asset: " + error);
  }
  restore_indices(model);
  return model;
}

}  // namespace microtrace::io::gltf
