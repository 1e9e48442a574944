#include "base/printable.hpp"
#include "io/gltf/animation/animations.hpp"
#include "io/gltf/document/index_text.hpp"

#include <algorithm>
#include <string>

namespace microtrace::io::gltf {
namespace {

std::string list_of_animations(const Asset& asset) {
  constexpr std::size_t kShown = 20;
  const std::vector<JsonValue>& animations = asset.array("animations");
  if (animations.empty()) return "the asset has no animations";
  std::string result = "the asset has";
  for (std::size_t i = 0; i < std::min(animations.size(), kShown); ++i) {
    result += (i == 0 ? " " : ", ") + std::to_string(i);
    const JsonValue* name = animations[i].find("name");
    result += name != nullptr ? " (" + printable(name->string().substr(0, 64)) + ")" : " (unnamed)";
  }
  if (animations.size() > kShown) result += ", ... " + std::to_string(animations.size() - 1);
  return result;
}

}  // namespace

std::vector<std::size_t> choose_animations(const Asset& asset, const std::string& wanted) {
  const std::vector<JsonValue>& animations = asset.array("animations");
  if (wanted.empty())
    return animations.empty() ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
  for (std::size_t i = 0; i < animations.size(); ++i) {
    const JsonValue* name = animations[i].find("name");
    if (name != nullptr && name->string() == wanted) return {i};
  }
  if (const auto index = index_in(wanted); index && *index < animations.size()) return {*index};
  std::vector<std::size_t> all;
  if (wanted == "all") {
    for (std::size_t i = 0; i < animations.size(); ++i) all.push_back(i);
    return all;
  }
  throw Error(ErrorKind::usage, asset.file(),
              "there is no animation " + in_quotes(wanted) + "; " + list_of_animations(asset));
}

}  // namespace microtrace::io::gltf
