// Writes draco.glb, meshopt.glb and meshopt_khr.glb. Each contains a sphere that only the module of
// Draco or of meshoptimizer can decode.
//
// usage: compressed_assets FOLDER

#include <cmath>
#include <cstdint>
#include <draco/compression/encode.h>
#include <filesystem>
#include <fstream>
#include <meshoptimizer.h>
#include <numbers>
#include <string>
#include <vector>

namespace {

constexpr std::uint32_t kColumns = 16, kRows = 8;  // of the sphere's faces

struct Sphere {
  std::vector<float> positions{};
  std::vector<std::uint32_t> corners{};
  [[nodiscard]] std::size_t points() const { return positions.size() / 3; }
};

Sphere make_sphere() {
  Sphere sphere;
  for (std::uint32_t y = 0; y <= kRows; ++y) {
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      const double u = 2 * std::numbers::pi * x / kColumns, v = std::numbers::pi * y / kRows;
      for (const double p : {std::sin(v) * std::cos(u), std::cos(v), std::sin(v) * std::sin(u)}) {
        sphere.positions.push_back(static_cast<float>(std::round(p * 1024) / 1024));
      }
    }
  }
  const auto at = [](std::uint32_t y, std::uint32_t x) { return y * kColumns + x % kColumns; };
  for (std::uint32_t y = 0; y < kRows; ++y) {
    for (std::uint32_t x = 0; x < kColumns; ++x) {
      const std::uint32_t a = at(y, x), b = at(y, x + 1), c = at(y + 1, x), d = at(y + 1, x + 1);
      if (y > 0) sphere.corners.insert(sphere.corners.end(), {a, b, c});
      if (y + 1 < kRows) sphere.corners.insert(sphere.corners.end(), {b, d, c});
    }
  }
  return sphere;
}

std::string draco_bytes(const Sphere& sphere) {
  draco::Mesh mesh;
  mesh.set_num_points(static_cast<std::uint32_t>(sphere.points()));
  draco::GeometryAttribute position;
  position.Init(draco::GeometryAttribute::POSITION, nullptr, 3, draco::DT_FLOAT32, false, 12, 0);
  auto* values = mesh.attribute(mesh.AddAttribute(position, true, mesh.num_points()));
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    values->SetAttributeValue(draco::AttributeValueIndex(i), &sphere.positions[3 * i]);
  }
  for (std::size_t i = 0; i < sphere.corners.size(); i += 3) {
    mesh.AddFace({draco::PointIndex(sphere.corners[i]), draco::PointIndex(sphere.corners[i + 1]),
                  draco::PointIndex(sphere.corners[i + 2])});
  }
  draco::Encoder encoder;
  encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  draco::EncoderBuffer bytes;
  if (!encoder.EncodeMeshToBuffer(mesh, &bytes).ok()) return {};
  return {bytes.data(), bytes.size()};
}

std::string meshopt_attributes(const void* values, std::size_t count, std::size_t stride,
                               int version) {
  meshopt_encodeVertexVersion(version);
  std::string bytes(meshopt_encodeVertexBufferBound(count, stride), '\0');
  bytes.resize(meshopt_encodeVertexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                          bytes.size(), values, count, stride));
  return bytes;
}

/// Returns colors for the filter COLOR: luma and chroma with 6 bits, alpha with 5 bits below a set
/// bit.
std::vector<std::uint8_t> stored_colors(const Sphere& sphere) {
  std::vector<std::uint8_t> result;
  for (std::size_t i = 0; i < sphere.positions.size(); i += 3) {
    const auto channel = [&](std::size_t k) {
      return static_cast<int>(std::round((sphere.positions[i + k] + 1) * 31.5F));
    };
    const int orange = (channel(0) - channel(2)) / 2, rest = channel(2) + orange;
    const int green = (channel(1) - rest) / 2;
    for (const int v : {rest + green, orange, green, 63}) {
      result.push_back(static_cast<std::uint8_t>(v));
    }
  }
  return result;
}

std::string meshopt_triangles(const Sphere& sphere) {
  meshopt_encodeIndexVersion(1);
  std::string bytes(meshopt_encodeIndexBufferBound(sphere.corners.size(), sphere.points()), '\0');
  bytes.resize(meshopt_encodeIndexBuffer(reinterpret_cast<unsigned char*>(bytes.data()),
                                         bytes.size(), sphere.corners.data(),
                                         sphere.corners.size()));
  return bytes;
}

std::string word(std::size_t number) {
  std::string bytes;
  for (int shift = 0; shift < 32; shift += 8) bytes += static_cast<char>(number >> shift & 255);
  return bytes;
}

/// Writes a GLB file with this JSON, whose outer braces are omitted, and this buffer.
void save(const std::filesystem::path& path, const std::string& extension, const std::string& rest,
          std::string binary) {
  std::string json =
      R"({"asset":{"version":"2.0"},"extensionsUsed":[")" + extension +
      R"(","KHR_materials_unlit"],"extensionsRequired":[")" + extension +
      R"("],"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("materials":[{"pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]},"extensions":{"KHR_materials_unlit":{}}}],)" +
      rest + "}";
  json.append((4 - json.size() % 4) % 4, ' ');
  binary.append((4 - binary.size() % 4) % 4, '\0');
  std::ofstream(path, std::ios::binary)
      << "glTF" << word(2) << word(28 + json.size() + binary.size()) << word(json.size()) << "JSON"
      << json << word(binary.size()) << std::string("BIN\0", 4) << binary;
}

std::string accessors(const Sphere& sphere, const char* positions_view, const char* corners_view) {
  return std::string(R"("accessors":[{)") + positions_view +
         R"("componentType":5126,"type":"VEC3","count":)" + std::to_string(sphere.points()) +
         R"(,"min":[-1,-1,-1],"max":[1,1,1]},{)" + corners_view +
         R"("componentType":5125,"type":"SCALAR","count":)" +
         std::to_string(sphere.corners.size()) + "}]";
}

void save_draco(const std::filesystem::path& path, const Sphere& sphere) {
  const std::string bytes = draco_bytes(sphere), size = std::to_string(bytes.size());
  const std::string rest =
      R"("buffers":[{"byteLength":)" + size + R"(}],"bufferViews":[{"buffer":0,"byteLength":)" +
      size + "}]," + accessors(sphere, "", "") +
      R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1,"material":0,)"
      R"("extensions":{"KHR_draco_mesh_compression":{"bufferView":0,"attributes":{"POSITION":0}}}}]}])";
  save(path, "KHR_draco_mesh_compression", rest, bytes);
}

/// The compressed views of an asset. The uncompressed data belong to the second buffer, which has
/// no bytes.
struct MeshoptViews {
  const char* extension;
  std::string bytes{};           // of the first buffer
  std::size_t uncompressed = 0;  // size of the second buffer
  std::string json{};            // of the views

  void add(const std::string& view, const char* mode, std::size_t count, std::size_t stride,
           const std::string& more = "") {
    bytes.resize((bytes.size() + 3) / 4 * 4);
    const std::string step = R"("byteStride":)" + std::to_string(stride) + ",";
    json += json.empty() ? "" : ",";
    json += R"({"buffer":1,"byteOffset":)" + std::to_string(uncompressed) + R"(,"byteLength":)" +
            std::to_string(count * stride) + "," + (std::string(mode) == "ATTRIBUTES" ? step : "") +
            R"("extensions":{")" + extension + R"(":{"buffer":0,"byteOffset":)" +
            std::to_string(bytes.size()) + R"(,"byteLength":)" + std::to_string(view.size()) + "," +
            step + R"("mode":")" + mode + R"(","count":)" + std::to_string(count) + more + "}}}";
    bytes += view;
    uncompressed += count * stride;
  }
};

/// Writes the sphere. With KHR_meshopt_compression, its attributes have version 1, and it has
/// colors.
void save_meshopt(const std::filesystem::path& path, const Sphere& sphere, const char* extension) {
  const bool is_khr = std::string(extension).starts_with("KHR");
  const std::size_t points = sphere.points();
  MeshoptViews views{extension};
  views.add(meshopt_attributes(sphere.positions.data(), points, 12, is_khr ? 1 : 0), "ATTRIBUTES",
            points, 12);
  views.add(meshopt_triangles(sphere), "TRIANGLES", sphere.corners.size(), 4);
  std::string accessors_json = accessors(sphere, R"("bufferView":0,)", R"("bufferView":1,)");
  if (is_khr) {
    views.add(meshopt_attributes(stored_colors(sphere).data(), points, 4, 1), "ATTRIBUTES", points,
              4, R"(,"filter":"COLOR")");
    accessors_json.insert(
        accessors_json.size() - 1,
        R"(,{"bufferView":2,"componentType":5121,"normalized":true,"type":"VEC4","count":)" +
            std::to_string(points) + "}");
  }
  const std::string rest =
      R"("buffers":[{"byteLength":)" + std::to_string(views.bytes.size()) + R"(},{"byteLength":)" +
      std::to_string(views.uncompressed) + R"(,"extensions":{")" + extension +
      R"(":{"fallback":true}}}],"bufferViews":[)" + views.json + "]," + accessors_json +
      R"(,"meshes":[{"primitives":[{"attributes":{"POSITION":0)" +
      (is_khr ? R"(,"COLOR_0":2)" : "") + R"(},"indices":1,"material":0}]}])";
  save(path, extension, rest, views.bytes);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const std::filesystem::path folder = argv[1];
  const Sphere sphere = make_sphere();
  save_draco(folder / "draco.glb", sphere);
  save_meshopt(folder / "meshopt.glb", sphere, "EXT_meshopt_compression");
  save_meshopt(folder / "meshopt_khr.glb", sphere, "KHR_meshopt_compression");
  return 0;
}
