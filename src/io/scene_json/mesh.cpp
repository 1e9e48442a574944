#include "io/scene_json/mesh.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "io/file.hpp"
#include "io/gltf/scene/scene.hpp"
#include "io/scene_json/path.hpp"
#include "scene/math/trigonometry.hpp"

#include <cmath>
#include <optional>
#include <utility>

#include <glm/geometric.hpp>

namespace microtrace::io {
namespace {

/// Returns a rotation by Rodrigues' formula: v -> cos v + sin (axis x v) + (1 - cos) axis (axis .
/// v), where axis is a unit vector.
DMat4 rotation(const DVec3& axis, double degrees) {
  const double sine = sin_degrees(degrees), cosine = cos_degrees(degrees);
  DMat4 out(1);
  for (glm::length_t column = 0; column < 3; ++column) {
    DVec3 v(0);
    v[column] = 1;
    const DVec3 turned =
        cosine * v + sine * glm::cross(axis, v) + (1 - cosine) * axis[column] * axis;
    out[column] = glm::dvec4(turned, 0);
  }
  return out;
}

DMat4 read_rotation(const JsonReader& json) {
  json.require_object({"axis", "angle"});
  const JsonReader axis = json.member("axis");
  const DVec3 direction = axis.vector();
  if (Vec3(direction) == Vec3(0)) axis.fail("must not be zero");
  const double length = std::sqrt(glm::dot(direction, direction));
  return rotation(direction / length, json.member("angle").number());
}

DVec3 read_scale(const JsonReader& json) {
  if (json.value().kind() == JsonValue::Kind::array) return json.vector();
  if (json.value().kind() == JsonValue::Kind::number) return DVec3(json.number());
  json.fail("must be a number or an array of three");
}

DMat4 read_matrix(const JsonReader& json) {
  const std::vector<JsonReader> items = json.items(16);
  DMat4 out(0);
  for (std::size_t i = 0; i < 16; ++i) {
    const double x = items[i].number();
    const double affine = i == 15 ? 1 : 0;
    if (i % 4 == 3 && x != affine) {
      std::string message = "must be ";
      message.append(decimal(affine)).append(" in an affine matrix, column by column, is ");
      items[i].fail(message.append(decimal(x)));
    }
    out[static_cast<glm::length_t>(i / 4)][static_cast<glm::length_t>(i % 4)] = x;
  }
  return out;
}

std::string read_mesh_file(const JsonReader& json, const std::filesystem::path& path) {
  try {
    return read_regular_file(path, kMaxFileSize);
  } catch (const Error& error) {
    std::string message = printable(path.string());
    json.fail(message.append(" ").append(error.diagnostic().message), error);
  }
}

/// Returns f(), and adds to its errors where the scene names the file with the mesh.
template <class F>
auto with_place(const JsonReader& file, const F& f) {
  try {
    return f();
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::limit) throw;
    Diagnostic diagnostic = error.diagnostic();
    diagnostic.message.append(" (named by ").append(file.pointer()).append(" of the scene)");
    throw Error(error.kind(), std::move(diagnostic));
  }
}

}  // namespace

DMat4 read_transform(const JsonReader& json) {
  json.require_object({"translation", "rotation", "scale", "matrix"});
  if (const auto matrix = json.find("matrix")) {
    if (json.value().members().size() == 1) return read_matrix(*matrix);
    matrix->fail("must not be combined with translation, rotation or scale");
  }
  DMat4 out(1);
  if (const auto turn = json.find("rotation")) out = read_rotation(*turn);
  if (const auto scale = json.find("scale")) {
    const DVec3 factors = read_scale(*scale);
    for (glm::length_t i = 0; i < 3; ++i) out[i] *= factors[i];
  }
  if (const auto move = json.find("translation")) out[3] = glm::dvec4(move->vector(), 1);
  return out;
}

/// A file's bytes and the reader that refers to them.
struct MeshFiles::File {
  explicit File(MemoryBudget* budget) : memory(budget) {}

  MemoryAccount memory;
  std::string bytes{};
  std::optional<GltfFile> reader{};
  std::size_t uses = 0;  // number of objects that are read from the file
};

MeshFiles::MeshFiles(const std::filesystem::path& folder, const LoadOptions& options)
    : folder_(folder), options_(options) {}
MeshFiles::~MeshFiles() = default;

void MeshFiles::expect(const JsonReader& json) {
  // If the member "file" is invalid, read() reports it.
  if (const JsonValue* file = json.value().find("file")) ++uses_[file->string()];
}

std::unique_ptr<MeshFiles::File> MeshFiles::open(const JsonReader& file,
                                                 const std::filesystem::path& path) const {
  auto result = std::make_unique<File>(memory_account().budget());
  const MemoryScope scope(result->memory);
  result->bytes = read_mesh_file(file, path);
  with_place(file, [&] {
    result->reader.emplace(result->bytes, printable(path.string()), path.parent_path(), options_);
  });
  return result;
}

LoadedScene MeshFiles::read(const JsonReader& json) {
  json.require_object({"name", "type", "color", "material", "file", "transform"});
  const JsonReader file = json.member("file");
  const std::filesystem::path path = folder_ / read_relative_path(file);
  const auto transform = json.find("transform");
  const DMat4 world_from_asset = transform ? read_transform(*transform) : DMat4(1);
  std::unique_ptr<File>& opened = files_[file.value().string()];
  std::size_t& uses = uses_[file.value().string()];
  if (!opened) {
    opened = open(file, path);
    opened->uses = uses;
  }
  LoadedScene result = with_place(
      file, [&] { return opened->reader->placed(options_.time, world_from_asset, opened->uses); });
  if (--uses == 0) files_.erase(file.value().string());
  return result;
}

}  // namespace microtrace::io
