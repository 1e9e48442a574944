#include "float_environment.hpp"
#include "io/file.hpp"
#include "io/gltf/scene.hpp"
#include "io/json/document.hpp"
#include "io/scene_json/scene.hpp"

#include <microtrace/io.hpp>

#include <algorithm>
#include <unistd.h>

namespace microtrace {
namespace {

constexpr std::string_view glb_magic = "glTF";

std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return ending;
}

/// Throws if a JSON text can't start like this, as its whole would; garbage need not be read on.
void require_start_of_json(std::string_view first, const std::string& name) {
  const std::size_t start = first.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  if (start == std::string_view::npos) return;
  // Any other start is a first token that is no JSON, and complete within a chunk.
  const bool may_go_on =
      std::string_view("{[\"-0123456789tfn").find(first[start]) != std::string_view::npos;
  if (!may_go_on) const io::JsonDocument document(first, name);
}

}  // namespace

LoadedScene load_scene(const std::filesystem::path& path) {
  const FloatEnvironment environment;
  const bool standard_input = path == "-";
  const std::string ending = lower_case_ending(path);
  const std::string name = standard_input ? "(standard input)" : path.string();
  const auto inspect = [&](std::string_view first) {
    if (ending != ".glb" && !first.starts_with(glb_magic)) require_start_of_json(first, name);
  };
  const std::string bytes =
      standard_input ? io::read_descriptor(STDIN_FILENO, name, io::max_file_size, inspect)
                     : io::read_file(path, io::max_file_size, inspect);
  const std::filesystem::path folder = path.parent_path();
  if (ending == ".gltf" || ending == ".glb") return io::load_gltf(bytes, name, folder);
  if (ending == ".json") return io::read_json_scene(io::JsonDocument(bytes, name), folder);
  return parse_scene(bytes, name, folder);
}

LoadedScene parse_scene(std::string_view bytes, const std::string& name,
                        const std::filesystem::path& folder) {
  const FloatEnvironment environment;
  if (bytes.starts_with(glb_magic)) return io::load_gltf(bytes, name, folder);
  const io::JsonDocument document(bytes, name);
  // Every glTF asset has the member "asset", and no scene of our own has.
  if (document.root().find("asset") != nullptr) return io::load_gltf(bytes, name, folder);
  return io::read_json_scene(document, folder);
}

}  // namespace microtrace
