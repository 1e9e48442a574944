#include "base/memory_account.hpp"
#include "base/system/float_environment.hpp"
#include "base/system/processors.hpp"
#include "render/aovs/aov_painter.hpp"
#include "render/film/clock.hpp"
#include "render/film/tiles.hpp"
#include "render/prepared/view.hpp"

#include <microtrace/error.hpp>
#include <microtrace/render_aovs.hpp>

#include <string>
#include <variant>

namespace microtrace {
namespace {

void check(const AovBuffer& buffer) {
  const auto refuse = [&](const std::string& message) {
    throw Error(ErrorKind::usage, "",
                "the buffer of " + std::string(name_of(buffer.aov)) + " " + message);
  };
  if (std::holds_alternative<std::uint32_t*>(buffer.data) != (buffer.aov == Aov::id))
    refuse(buffer.aov == Aov::id ? "needs std::uint32_t" : "needs float");
  if (std::visit([](auto* data) { return data == nullptr; }, buffer.data))
    refuse("is a null pointer");
  const std::size_t count = channels_of(buffer.aov).size();
  if (buffer.channel && *buffer.channel >= count)
    refuse("asks for channel " + std::to_string(*buffer.channel) + " of 0 to " +
           std::to_string(count - 1));
}

}  // namespace

void render_aovs(const PreparedScene& scene, const Camera& camera, ImageSize size,
                 std::span<const AovBuffer> buffers, const RenderOptions& options) {
  const FloatEnvironment environment;
  MemoryAccount memory(options.memory);
  const MemoryScope scope(memory);
  for (const AovBuffer& buffer : buffers) check(buffer);
  const PixelRect window = window_of(size, options.crop);
  Threads threads{.wanted = thread_count(options.threads), .run = options.run_threads};
  const auto start = Clock::now();
  const std::shared_ptr<const PreparedScene::Content> content(std::shared_ptr<void>(),
                                                              &scene.content());
  const SceneView view(content_for(content, camera, size), camera, size);
  (void)view.content->bvh();
  const auto built = Clock::now();
  const World world = view.unlit_world(1);
  const AovPainter painter(world, camera, buffers, window);
  for_each_tile(
      window, threads, [&](const PixelRect& tile, const auto& /*poll*/) { painter.paint(tile); },
      options.progress);
  if (options.counts != nullptr) {
    const ImageSize part = window.size();
    *options.counts = {.samples = std::uint64_t{part.width} * part.height,
                       .samples_per_pixel = 1,
                       .stages = threads.stages,
                       .missing_threads = threads.missing};
  }
  if (options.times != nullptr)
    *options.times = {.build = seconds(start, built), .trace = seconds(built, Clock::now())};
}

}  // namespace microtrace
