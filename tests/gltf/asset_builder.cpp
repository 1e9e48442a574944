#include "gltf/asset_builder.hpp"

#include "io/gltf/scene/scene.hpp"

#include <algorithm>
#include <cstring>

#include <glm/common.hpp>
#include <nlohmann/json.hpp>

namespace microtrace::tests {
namespace {

std::string little_endian(std::uint32_t value) {
  std::string bytes;
  for (unsigned shift = 0; shift < 32; shift += 8)
    bytes += static_cast<char>(value >> shift & 0xFF);
  return bytes;
}

template <typename Integer>
std::string narrowed(const std::vector<std::uint32_t>& numbers) {
  return bytes_of(std::vector<Integer>(numbers.begin(), numbers.end()));
}

}  // namespace

std::size_t AssetBuilder::add(const char* array, Json item) {
  json[array].push_back(std::move(item));
  return json[array].size() - 1;
}

std::size_t AssetBuilder::add_view(std::string_view bytes, std::size_t stride) {
  buffer = padded(std::move(buffer), '\0');
  Json view = {{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}};
  if (stride != 0) view["byteStride"] = stride;
  buffer += bytes;
  return add("bufferViews", std::move(view));
}

std::size_t AssetBuilder::add_positions(const std::vector<Vec3>& positions) {
  const std::size_t view = add_view(bytes_of(positions));
  Vec3 least(positions.at(0)), greatest(positions.at(0));
  for (const Vec3& p : positions) {
    least = glm::min(least, p);
    greatest = glm::max(greatest, p);
  }
  return add("accessors", {{"bufferView", view},
                           {"componentType", kFloat32},
                           {"count", positions.size()},
                           {"type", "VEC3"},
                           {"min", {least.x, least.y, least.z}},
                           {"max", {greatest.x, greatest.y, greatest.z}}});
}

std::size_t AssetBuilder::add_indices(const std::vector<std::uint32_t>& indices,
                                      ComponentType type) {
  const std::string bytes = type == kUint8    ? narrowed<std::uint8_t>(indices)
                            : type == kUint16 ? narrowed<std::uint16_t>(indices)
                                              : bytes_of(indices);
  const std::size_t view = add_view(bytes);
  return add("accessors", {{"bufferView", view},
                           {"componentType", type},
                           {"count", indices.size()},
                           {"type", "SCALAR"}});
}

std::size_t AssetBuilder::add_accessor(const char* shape, const std::string& bytes,
                                       int component_type, bool normalized) {
  const std::string_view kind = shape;
  const std::size_t width = kind == "SCALAR" ? 1 : kind == "MAT4" ? 16 : kind.back() - '0';
  const std::size_t size = component_type <= kUint8 ? 1 : component_type <= kUint16 ? 2 : 4;
  Json accessor = {{"bufferView", add_view(bytes)},
                   {"componentType", component_type},
                   {"count", bytes.size() / (width * size)},
                   {"type", shape}};
  if (normalized) accessor["normalized"] = true;
  if (component_type == kFloat32 && width == 1) {
    std::vector<float> numbers(bytes.size() / size);
    std::memcpy(numbers.data(), bytes.data(), bytes.size());
    accessor["min"] = {*std::ranges::min_element(numbers)};
    accessor["max"] = {*std::ranges::max_element(numbers)};
  }
  return add("accessors", std::move(accessor));
}

void AssetBuilder::animate(std::size_t index, std::size_t node, const char* path, std::size_t input,
                           std::size_t output, const char* interpolation) {
  Json& animation = json["animations"][index];
  animation["channels"].push_back(
      {{"sampler", animation.contains("samplers") ? animation["samplers"].size() : 0},
       {"target", {{"node", node}, {"path", path}}}});
  animation["samplers"].push_back(
      {{"input", input}, {"output", output}, {"interpolation", interpolation}});
}

std::size_t AssetBuilder::add_object(Json primitive) {
  const std::size_t mesh = add("meshes", {{"primitives", Json::array({std::move(primitive)})}});
  const std::size_t node = add("nodes", {{"mesh", mesh}});
  if (!json.contains("scenes")) {
    json["scene"] = 0;
    add("scenes", Json::object());
  }
  json["scenes"][0]["nodes"].push_back(node);
  return node;
}

Json AssetBuilder::with_buffer(const char* uri) const {
  Json result = json;
  if (buffer.empty()) return result;
  Json object = {{"byteLength", buffer.size()}};
  if (uri != nullptr) object["uri"] = uri;
  result["buffers"] = Json::array({object});
  return result;
}

std::string AssetBuilder::embedded() const {
  return with_buffer(("data:application/octet-stream;base64," + base64(buffer)).c_str()).dump(1);
}

std::string AssetBuilder::glb() const {
  return glb_file(
      {{kJsonChunk, padded(with_buffer(nullptr).dump(), ' ')}, {kBinChunk, padded(buffer, '\0')}});
}

std::string glb_file(const std::vector<GlbChunk>& chunks, std::uint32_t version) {
  std::string body;
  for (const GlbChunk& chunk : chunks) {
    body += little_endian(static_cast<std::uint32_t>(chunk.data.size()));
    body += little_endian(chunk.type) + chunk.data;
  }
  return "glTF" + little_endian(version) +
         little_endian(static_cast<std::uint32_t>(body.size() + 12)) + body;
}

std::string padded(std::string bytes, char filler) {
  while (bytes.size() % 4 != 0) bytes += filler;
  return bytes;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
  }
  return text;
}

AssetBuilder cube() {
  AssetBuilder asset;
  std::vector<Vec3> corners;
  for (int i = 0; i < 8; ++i) {
    corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  }
  const std::size_t positions = asset.add_positions(corners);
  const std::size_t indices =
      asset.add_indices({0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                         2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5},
                        kUint16);
  asset.add("materials", {{"pbrMetallicRoughness", {{"baseColorFactor", {1, 0.25, 0.125, 1}}}}});
  const std::size_t node = asset.add_object(
      {{"attributes", {{"POSITION", positions}}}, {"indices", indices}, {"material", 0}});
  asset.json["nodes"][node]["name"] = "Cube";
  return asset;
}

std::string mutated(const AssetBuilder& asset, const char* where, const char* value) {
  nlohmann::json json = nlohmann::json::parse(asset.embedded());
  const nlohmann::json::json_pointer pointer(where);
  if (pointer.empty()) {
    json.merge_patch(nlohmann::json::parse(value));
  } else if (*value != '\0') {
    json[pointer] = nlohmann::json::parse(value);
  } else {
    json[pointer.parent_pointer()].erase(pointer.back());
  }
  return json.dump(1);
}

LoadedScene load_gltf(std::string_view bytes, const std::string& name,
                      const std::filesystem::path& folder, const DMat4& world_from_asset,
                      const LoadOptions& options) {
  return io::GltfFile(bytes, name, folder, options).placed(options.time, world_from_asset);
}
LoadedScene load(const std::string& bytes) {
  return load_gltf(bytes, "test.gltf", "nowhere");
}
LoadedScene load(const AssetBuilder& asset) {
  return load(asset.embedded());
}
LoadedScene load(const AssetBuilder& asset, const LoadOptions& options) {
  return load_gltf(asset.embedded(), "test.gltf", "nowhere", DMat4(1), options);
}

Vec4 color_of(const LoadedScene& loaded, std::size_t object) {
  return material_of(loaded.scene, loaded.scene.objects.at(object)).base_color;
}

std::vector<std::array<Vec3, 3>> triangles_of(const Object& object) {
  const Mesh& mesh = std::get<Mesh>(object.shape);
  std::vector<std::array<Vec3, 3>> result;
  for (const auto& [a, b, c] : mesh.triangles) {
    result.push_back({mesh.positions[a], mesh.positions[b], mesh.positions[c]});
  }
  return result;
}

std::vector<std::string> texts(const std::vector<Diagnostic>& warnings) {
  std::vector<std::string> result;
  for (const Diagnostic& warning : warnings) {
    result.push_back(warning.pointer + ": " + warning.message);
  }
  return result;
}

}  // namespace microtrace::tests
