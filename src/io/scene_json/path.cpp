#include "io/scene_json/path.hpp"

#include <algorithm>
#include <string>

namespace microtrace::io {

std::filesystem::path read_relative_path(const JsonReader& json) {
  const std::string name = json.name();
  if (name.find('\0') != std::string::npos) json.fail("must not contain a zero byte");
  std::filesystem::path path(name);
  const bool climbs = std::find(path.begin(), path.end(), "..") != path.end();
  if (path.is_absolute() || climbs) {
    json.fail("must be a path within the scene's folder: relative and without \"..\"");
  }
  return path;
}

}  // namespace microtrace::io
