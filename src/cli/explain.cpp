#include "cli/explain.hpp"

#include "base/memory_account.hpp"
#include "base/text/printable.hpp"
#include "cli/camera.hpp"
#include "cli/options/option_value.hpp"
#include "cli/report/explanation_text.hpp"
#include "cli/report/standard_output.hpp"
#include "cli/report/warnings.hpp"

#include <microtrace/explain.hpp>
#include <microtrace/io.hpp>
#include <microtrace/memory.hpp>
#include <microtrace/prepared_scene.hpp>

#include <cstdint>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

namespace microtrace::cli {
namespace {

Explanation explain_pixel(const PreparedScene& scene, const Arguments& arguments,
                          const ExplainOptions& options) {
  const ImageSize size = arguments.size.value_or(scene.scene().size);
  const Camera camera = choose_camera(scene.scene(), arguments.camera, size);
  const DVec2 at = *arguments.explain.pixel;
  if (!(at.x >= 0 && at.x < size.width && at.y >= 0 && at.y < size.height)) {
    refuse_usage("--pixel: must be within the picture, from 0,0 to " +
                 std::to_string(size.width - 1) + "," + std::to_string(size.height - 1));
  }
  Explanation result = explain(scene, camera, size, at.x, at.y, options);
  if (const auto index = camera_index(scene.scene(), arguments.camera))
    result.pixel->camera = scene.scene().cameras[*index].name;
  return result;
}

}  // namespace

void explain_ray(const Arguments& arguments) {
  MemoryBudget memory(arguments.memory_limit.value_or(default_memory_limit()));
  LoadOptions load = arguments.load;
  load.memory = &memory;
  load.detail = SurfaceDetail::shape_and_color;
  SceneFile file(arguments.scene, load);
  LoadedScene loaded = file.at(load.time);
  Warnings(arguments).report(loaded.warnings);
  const PreparedScene scene(std::move(loaded.scene),
                            {.threads = arguments.threads, .memory = &memory});
  ExplainOptions options;
  MemoryAccount account(&memory);
  if (arguments.explain.is_all) {
    options.max_hits = options.max_misses = std::numeric_limits<std::size_t>::max();
    constexpr std::uint64_t kPerPrimitive = 2048;  // bytes, with the text
    account.take(kPerPrimitive * scene.bvh().primitives().count(),
                 "the explanation of all primitives");
  }
  const std::optional<WorldRay>& ray = arguments.explain.ray;
  const Explanation explanation =
      ray ? explain_in_scene(scene, ray->in_scene(scene.scene().origin), options)
          : explain_pixel(scene, arguments, options);
  write_standard_output(arguments.explain.is_json ? explanation_json(explanation)
                                                  : explanation_text(explanation));
}

}  // namespace microtrace::cli
