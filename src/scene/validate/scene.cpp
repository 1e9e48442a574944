#include "base/system/float_environment.hpp"
#include "scene/material_textures.hpp"
#include "scene/mesh/shared_meshes.hpp"
#include "scene/validate/check_indices.hpp"
#include "scene/validate/numbers.hpp"
#include "scene/validate/validate.hpp"

#include <microtrace/validate.hpp>

#include <algorithm>
#include <cstddef>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace microtrace {
namespace {

[[noreturn]] void refuse(const std::string& pointer, const BrokenRule& rule) {
  Diagnostic where;
  where.pointer = pointer;
  if (!rule.field.empty()) where.pointer.append("/").append(rule.field);
  where.message = rule.message;
  throw Error(rule.kind, where);
}

std::string item(const char* array, std::size_t index) {
  return std::string("/").append(array).append("/").append(std::to_string(index));
}

/// Checks that `index` is less than `size`. Builds the JSON pointer only for errors, because scenes
/// may have millions of objects.
void check_index(const char* array, std::size_t place, const char* field, std::size_t index,
                 std::size_t size) {
  if (index < size) return;
  refuse(item(array, place), {.field = field,
                              .message = "index " + std::to_string(index) +
                                         " is out of range: there are " + std::to_string(size)});
}

void check_image(std::size_t place, const Image& image) {
  const std::size_t samples = std::visit([](const auto& s) { return s.size(); }, image.samples);
  const bool is_right = image.width >= 1 && image.height >= 1 && image.channels >= 1 &&
                        image.channels <= 4 &&
                        std::size_t{image.width} * image.height <= samples / image.channels &&
                        std::size_t{image.width} * image.height * image.channels == samples;
  if (is_right) return;
  refuse(item("images", place),
         {.field = "samples",
          .message = "must hold width x height x channels numbers, with 1 to 4 channels"});
}

void check_map(const Environment& environment) {
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map == nullptr) return;
  const bool is_right = *map != nullptr && (*map)->width >= 1 && (*map)->height >= 1 &&
                        (*map)->width <= kMaxImageSide && (*map)->height <= kMaxImageSide &&
                        (*map)->pixels.size() == std::size_t{(*map)->width} * (*map)->height;
  if (!is_right)
    refuse("/environment", {.field = "content",
                            .message = "must be a map of width x height pixels, each side 1 to " +
                                       std::to_string(kMaxImageSide)});
}

/// Checks the indices and sizes outside meshes.
void check_references(const Scene& scene) {
  for (const ObjectRun& run : scene.objects.runs()) {
    if (const auto& material = run.first->material)
      check_index("objects", run.begin, "material", *material, scene.materials.size());
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    for_each_texture(scene.materials[i], [&](const TextureUse& use, ColorEncoding) {
      check_index("materials", i, "texture", use.texture, scene.textures.size());
    });
  }
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    if (scene.textures[i].image)
      check_index("textures", i, "image", *scene.textures[i].image, scene.images.size());
  }
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (scene.images[i]) check_image(i, *scene.images[i]);
  }
  if (scene.environment) check_map(*scene.environment);
}

/// Checks the numbers that belong to the scene itself.
std::optional<BrokenRule> broken_member(const Scene& scene) {
  auto size = validate(scene.size);
  if (size) size->field.insert(0, "size/");
  constexpr double kDouble = std::numeric_limits<double>::max(),
                   kFloat = std::numeric_limits<float>::max();
  return first_of({in_range("origin", scene.origin, -kDouble, kDouble), std::move(size),
                   in_range("background", scene.background, -kFloat, kFloat),
                   at_least("epsilon", scene.epsilon, 0)});
}

}  // namespace

void check_indices(const Scene& scene) {
  SharedMeshes checked;
  for (const ObjectRun& run : scene.objects.runs()) {
    const PlacedMesh mesh = run.mesh(0);
    if (!mesh || !checked.add(*mesh.arrays)) continue;
    if (const auto broken = broken_index(*mesh.arrays))
      refuse(item("objects", run.begin) + "/shape", *broken);
  }
  check_references(scene);
}

void validate(const Scene& scene) {
  const FloatEnvironment environment;
  SharedMeshes checked;
  for (const ObjectRun& run : scene.objects.runs()) {
    if (const PlacedMesh first = run.mesh(0); first.placement != nullptr) {
      for (std::size_t i = 0; i < run.count; ++i)
        if (const auto broken = broken_placement(run.mesh(i)))
          refuse(item("objects", run.begin + i) + "/shape", *broken);
      if (!checked.add(*first.arrays)) continue;
    }
    if (const auto broken = validate(run.first->shape))
      refuse(item("objects", run.begin) + "/shape", *broken);
  }
  check_references(scene);
  if (const auto broken = broken_member(scene)) refuse("", *broken);
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) {
    if (const auto broken = validate(scene.cameras[i].camera))
      refuse(item("cameras", i) + "/camera", *broken);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    if (const auto broken = validate(scene.materials[i])) refuse(item("materials", i), *broken);
  }
  for (std::size_t i = 0; i < scene.lights.size(); ++i) {
    if (const auto broken = validate(scene.lights[i].light))
      refuse(item("lights", i) + "/light", *broken);
  }
  if (scene.environment) check_environment(*scene.environment);
}

void check_environment(const Environment& environment, const RadianceMap* valid_map) {
  const auto* map = std::get_if<std::shared_ptr<const RadianceMap>>(&environment.content);
  if (map != nullptr && *map != nullptr && map->get() == valid_map) {
    Environment without_map = environment;
    without_map.content = Vec3(0);
    return check_environment(without_map);
  }
  check_map(environment);
  if (const auto broken = validate(environment)) refuse("/environment", *broken);
}

}  // namespace microtrace
