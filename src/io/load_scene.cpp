#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "io/file.hpp"
#include "io/file_name.hpp"
#include "io/gltf/scene/scene.hpp"
#include "io/json/document.hpp"
#include "io/load_clock.hpp"
#include "io/scene_json/scene.hpp"
#include "scene/mesh/mesh_memory.hpp"
#include "scene/mesh/shared_meshes.hpp"

#include <microtrace/io.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unistd.h>
#include <utility>
#include <variant>

namespace microtrace {
namespace {

constexpr std::string_view kGlbMagic = "glTF";

/// File extensions of other common formats, each with a space on both sides, and the remedy.
struct ForeignFormats {
  std::string_view extensions, remedy;
};
constexpr ForeignFormats kForeignFormats[] = {
    {" .3ds .3mf .dae .fbx .ifc .obj .off .ply .stl .vrml .wrl .x .x3d ",
     "convert the file, for example with Blender (File > Export > glTF 2.0) or with assimp (assimp "
     "export FILE out.glb)"},
    {" .abc .blend .usd .usda .usdc .usdz ",
     "convert the file, for example with Blender (File > Export > glTF 2.0)"},
    {" .iges .igs .step .stp ", "convert the file, for example with FreeCAD (File > Export)"},
    {" .b3dm .cmpt .i3dm .pnts ", "extract its glTF, for example with 3d-tiles-tools"},
    {" .splat .spz ", "Gaussian splats can't be drawn"}};

/// The first bytes of files that are not scenes themselves.
struct Wrapping {
  std::string_view begin, message;
};
constexpr Wrapping kWrappings[] = {
    {"\x1F\x8B", "is compressed by gzip; decompress it with gunzip"},
    {"PK\3\4", "is a ZIP archive; unpack it"},
    {"version https://git-lfs", "is a pointer of Git LFS instead of the file; run git lfs pull"}};

/// Returns the text without leading white space and byte order mark.
std::string_view behind_space(std::string_view text) {
  return text.substr(std::min(text.find_first_not_of(" \t\r\n\xEF\xBB\xBF"), text.size()));
}

/// Throws if the file has the extension of another format and its bytes are neither JSON nor GLB.
void refuse_foreign_format(const std::string& extension, std::string_view first,
                           const std::string& name) {
  if (first.starts_with(kGlbMagic) || behind_space(first).starts_with('{')) return;
  const std::string word = " " + extension + " ";
  for (const auto& [extensions, remedy] : kForeignFormats) {
    if (extensions.find(word) == std::string_view::npos) continue;
    throw Error(ErrorKind::unsupported, name,
                "microtrace reads JSON scenes and glTF (.gltf, .glb), not " + extension + "; " +
                    std::string(remedy));
  }
}

/// Throws if the bytes are those of a file that contains or replaces another one.
void refuse_wrapping(std::string_view first, const std::string& name) {
  for (const auto& [begin, message] : kWrappings) {
    if (first.starts_with(begin)) throw Error(ErrorKind::unsupported, name, std::string(message));
  }
}

/// Throws if no JSON text can start with these bytes. This avoids reading a long file that is not
/// JSON to its end.
void require_start_of_json(std::string_view first, const std::string& name) {
  const std::string_view text = behind_space(first);
  if (text.empty()) return;
  // Any other first character begins an invalid token that is complete within this chunk.
  const bool may_go_on =
      std::string_view("{[\"-0123456789tfn").find(text[0]) != std::string_view::npos;
  if (!may_go_on) const io::JsonDocument document(first, name);
}

using Reader = std::variant<io::JsonDocument, io::GltfFile>;

/// Opens a scene. `extension` is the file's extension in lower case. If it is unknown, the format
/// is detected from the content.
Reader open(std::string_view bytes, const std::string& extension, const std::string& name,
            const std::filesystem::path& folder, const LoadOptions& options) {
  if (extension == ".gltf" || extension == ".glb" || bytes.starts_with(kGlbMagic)) {
    return io::GltfFile(bytes, name, folder, options);
  }
  io::LoadClock clock(options.times);
  io::JsonDocument document = io::naming_file(name, [&] { return io::JsonDocument(bytes, name); });
  clock.lap(&LoadTimes::validate);
  // Every glTF asset has the member "asset", and no scene in microtrace's own format has it.
  if (extension != ".json" && document.root().find("asset") != nullptr) {
    return io::GltfFile(bytes, name, folder, options);
  }
  return document;
}

/// Size in bytes of the images and meshes that a glTF file's scenes share.
std::uint64_t memory_of_shared(const Scene& scene) {
  std::uint64_t result = 0;
  for (const auto& image : scene.images) {
    if (image == nullptr) continue;
    result += std::visit([](const auto& samples) { return samples.size() * sizeof(samples[0]); },
                         image->samples);
  }
  SharedMeshes known;
  for (const ObjectRun& run : scene.objects.runs()) {
    const PlacedMesh mesh = run.mesh(0);
    if (mesh.placement != nullptr && known.add(*mesh.arrays)) result += memory_of(*mesh.arrays);
  }
  return result;
}

LoadedScene read(Reader& reader, const std::filesystem::path& folder, LoadOptions options) {
  if (auto* gltf = std::get_if<io::GltfFile>(&reader)) {
    LoadedScene result = gltf->at(options.time);
    result.format = SceneFormat::gltf;
    return result;
  }
  io::LoadClock clock(options.times);
  const io::JsonDocument& document = std::get<io::JsonDocument>(reader);
  if (!options.variant.empty())
    throw Error(ErrorKind::usage, document.file(), "has no variants, so none can be chosen");
  if (!options.animation.empty())
    throw Error(ErrorKind::usage, document.file(), "has no animations, so none can be chosen");
  if (options.detail == SurfaceDetail::usual) options.detail = SurfaceDetail::color;
  LoadedScene result = io::naming_file(
      document.file(), [&] { return io::read_json_scene(document, folder, options); });
  if (options.time) {
    result.warnings.push_back({.file = document.file(),
                               .pointer = {},
                               .message = "has no animation; the time has no effect",
                               .excerpt = {}});
  }
  clock.lap(&LoadTimes::bake);
  return result;
}

}  // namespace

struct SceneFile::Content {
  Content(const std::filesystem::path& path, LoadOptions wanted)
      : folder(path.parent_path()),
        options(std::move(wanted)),
        memory(options.memory),
        memory_of_scene(options.memory) {}

  std::filesystem::path folder;
  LoadOptions options;
  MemoryAccount memory, memory_of_scene;
  std::string bytes{};
  std::optional<Reader> reader{};
};

SceneFile::SceneFile(const std::filesystem::path& path, LoadOptions options) {
  const FloatEnvironment environment;
  const bool standard_input = path == "-";
  const std::string extension = io::lower_case_extension(path);
  const std::string name = standard_input ? "(standard input)" : path.string();
  const auto inspect = [&](std::string_view first) {
    refuse_foreign_format(extension, first, name);
    refuse_wrapping(first, name);
    if (extension != ".glb" && !first.starts_with(kGlbMagic)) require_start_of_json(first, name);
  };
  content_ = std::make_unique<Content>(path, std::move(options));
  Content& content = *content_;
  const MemoryScope scope(content.memory);
  io::LoadClock clock(content.options.times);
  if (standard_input)
    content.bytes = io::read_descriptor(STDIN_FILENO, name, io::kMaxFileSize, inspect);
  else if (content.options.needs_regular_file)
    content.bytes = io::read_regular_file(path, io::kMaxFileSize, inspect);
  else
    content.bytes = io::read_file(path, io::kMaxFileSize, inspect);
  clock.lap(&LoadTimes::read);
  content.reader.emplace(open(content.bytes, extension, name, content.folder, content.options));
}
SceneFile::~SceneFile() = default;
SceneFile::SceneFile(SceneFile&& other) noexcept = default;
SceneFile& SceneFile::operator=(SceneFile&& other) noexcept = default;

SceneFormat SceneFile::format() const {
  return std::holds_alternative<io::GltfFile>(*content_->reader) ? SceneFormat::gltf
                                                                 : SceneFormat::json;
}

SceneChoices SceneFile::choices() const {
  const auto* gltf = std::get_if<io::GltfFile>(&*content_->reader);
  return gltf != nullptr ? gltf->choices() : SceneChoices{};
}

LoadedScene SceneFile::at(std::optional<double> time) {
  const FloatEnvironment environment;
  if (time && std::isnan(*time)) throw Error(ErrorKind::usage, "time", "must be a number");
  LoadOptions options = content_->options;
  options.time = time;
  content_->memory_of_scene.clear();
  const MemoryScope scope(content_->memory_of_scene);
  return read(*content_->reader, content_->folder, options);
}

LoadedScene SceneFile::last(std::optional<double> time) {
  LoadedScene result = at(time);
  content_->reader.reset();
  std::string().swap(content_->bytes);
  content_->memory.clear();
  if (result.format == SceneFormat::gltf)
    content_->memory.take(memory_of_shared(result.scene),
                          "the images and shared meshes of a scene");
  return result;
}

LoadedScene load_scene(const std::filesystem::path& path, const LoadOptions& options) {
  return SceneFile(path, options).at(options.time);
}

LoadedScene parse_scene(std::string_view bytes, const std::string& name,
                        const std::filesystem::path& folder, const LoadOptions& options) {
  const FloatEnvironment environment;
  MemoryAccount memory(options.memory);
  const MemoryScope scope(memory);
  Reader reader = open(bytes, "", name, folder, options);
  return read(reader, folder, options);
}

}  // namespace microtrace
