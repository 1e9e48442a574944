#include "gltf/meshopt_asset.hpp"

#include <meshoptimizer.h>

namespace microtrace::tests {
namespace {

std::string text_of(const std::vector<unsigned char>& bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes.data()), size};
}

}  // namespace

std::string encoded_attributes(const std::string& bytes, std::size_t stride, int version) {
  const std::size_t count = bytes.size() / stride;
  std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, stride));
  meshopt_encodeVertexVersion(version);
  return text_of(out,
                 meshopt_encodeVertexBuffer(out.data(), out.size(), bytes.data(), count, stride));
}

std::string encoded_triangles(const std::vector<unsigned>& indices) {
  meshopt_encodeIndexVersion(1);
  std::vector<unsigned char> out(meshopt_encodeIndexBufferBound(indices.size(), 1000));
  return text_of(out,
                 meshopt_encodeIndexBuffer(out.data(), out.size(), indices.data(), indices.size()));
}

std::string encoded_indices(const std::vector<unsigned>& indices) {
  std::vector<unsigned char> out(meshopt_encodeIndexSequenceBound(indices.size(), 1000));
  return text_of(
      out, meshopt_encodeIndexSequence(out.data(), out.size(), indices.data(), indices.size()));
}

MeshoptAsset::MeshoptAsset(const char* with_extension) : extension(with_extension) {
  asset.json["extensionsUsed"] =
      asset.json["extensionsRequired"] = {extension, "KHR_mesh_quantization"};
}

std::size_t MeshoptAsset::add_view(const std::string& bytes, const char* mode, std::size_t count,
                                   std::size_t stride, const char* filter) {
  const std::size_t view = asset.add_view(bytes);
  Json& json = asset.json["bufferViews"][view];
  Json compression = json;
  compression.update({{"mode", mode}, {"count", count}, {"byteStride", stride}});
  if (filter != nullptr) compression["filter"] = filter;
  json = {{"buffer", 1},
          {"byteOffset", uncompressed},
          {"byteLength", count * stride},
          {"extensions", {{extension, compression}}}};
  if (std::string(mode) == "ATTRIBUTES") json["byteStride"] = stride;
  uncompressed += (count * stride + 3) / 4 * 4;
  return view;
}

std::size_t MeshoptAsset::add_accessor(std::size_t view, int type, const char* shape,
                                       std::size_t count, bool normalized) {
  return asset.add("accessors", {{"bufferView", view},
                                 {"componentType", type},
                                 {"normalized", normalized},
                                 {"count", count},
                                 {"type", shape},
                                 {"min", Json::array({0, 0, 0})},
                                 {"max", Json::array({0, 0, 0})}});
}

Json MeshoptAsset::json() const {
  Json result = Json::parse(asset.embedded());
  result["buffers"].push_back(
      {{"byteLength", uncompressed}, {"extensions", {{extension, {{"fallback", true}}}}}});
  for (Json& accessor : result["accessors"]) {
    if (accessor["type"] != "VEC3") accessor.erase("min"), accessor.erase("max");
  }
  return result;
}

}  // namespace microtrace::tests
