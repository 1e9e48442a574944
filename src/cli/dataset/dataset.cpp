#include "cli/dataset/dataset.hpp"

#include "cli/dataset/plan.hpp"
#include "cli/dataset/view_renderer.hpp"
#include "cli/pictures/render_picture.hpp"

#include <microtrace/dataset.hpp>
#include <microtrace/read_files.hpp>
#include <microtrace/version.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <set>

namespace microtrace::cli {
namespace {

namespace fs = std::filesystem;

/// Throws Error (usage) if two views would have files with the same name.
void check_names(const Arguments& arguments, const std::vector<DatasetView>& views) {
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    const std::string name = stem_of(arguments, views[i], i);
    if (!names.insert(name).second) {
      refuse_usage("--name: views share the file name " + name +
                   "; add {view:06d} or give the views different names");
    }
  }
}

DatasetIdentity identity_of(const Arguments& arguments, const std::vector<DatasetView>& views,
                            std::uint64_t digest) {
  return {.program = "microtrace " MICROTRACE_VERSION_TEXT,
          .scene = fs::path(arguments.scene).filename().string(),
          .digest = digest,
          .options = arguments.dataset.identity,
          .views = static_cast<std::uint32_t>(views.size()),
          .folder = fs::current_path().string(),
          .arguments = arguments.dataset.command_line};
}

/// Writes the files about all views. `scene` is that of the first view.
void finish(const Arguments& arguments, const std::vector<DatasetView>& views,
            const DatasetFolder& folder, const Scene& scene) {
  const auto parts = [&](DatasetFormat format) {
    std::vector<fs::path> paths;
    for (std::uint32_t view = 0; view < views.size(); ++view)
      paths.push_back(folder.path() / annotations_name(arguments, views[view], view, format));
    return paths;
  };
  std::vector<std::string> more;
  if (writes(arguments, DatasetFormat::coco)) {
    more.emplace_back("coco.json");
    join_coco(parts(DatasetFormat::coco), scene, arguments.dataset.coco.categories,
              folder.path() / more.back());
  }
  if (writes(arguments, DatasetFormat::bop)) {
    join_bop(parts(DatasetFormat::bop), folder.path() / kBopScene);
    for (const char* name : {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"})
      more.push_back(std::string(kBopScene) + name);
    for (const NamedFile& file : bop_models(scene)) {
      more.push_back("bop/" + file.name);
      write_dataset_file(folder.path() / more.back(), file.bytes);
    }
  }
  folder.write_manifest(more);
}

void report(const Arguments& arguments, std::size_t rendered, std::size_t kept,
            std::uint32_t missing, double seconds) {
  if (arguments.quiet || arguments.progress == Progress::json) return;
  std::fprintf(stderr, "%s: rendered %zu views in %.1f s", arguments.output.c_str(), rendered,
               seconds);
  if (kept > 0) std::fprintf(stderr, ", kept %zu", kept);
  if (missing > 0) std::fprintf(stderr, "; %u views of other shards are not rendered yet", missing);
  std::fprintf(stderr, "\n");
}

}  // namespace

void write_dataset(const Arguments& given) {
  Arguments arguments = given;
  const auto begin = std::chrono::steady_clock::now();
  if (arguments.scene == "-") refuse_usage("SCENE: a data set needs a file, not standard input");
  ReadDigest digest;
  const std::vector<DatasetView> views = views_of(arguments);
  check_names(arguments, views);
  Warnings warnings(arguments);
  ViewRenderer renderer(arguments, warnings);
  const std::vector<std::uint32_t> order = rendering_order(views, arguments.dataset.shard);
  renderer.load(views.front());  // the same view in all shards, so that the digests agree
  DatasetFolder folder(arguments.output, identity_of(arguments, views, digest.value()));
  const auto progress = progress_of(arguments, static_cast<std::uint32_t>(order.size()));
  std::size_t rendered = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (!folder.is_whole(order[i])) {
      folder.finish(order[i], renderer.render(views[order[i]], order[i], folder.path()));
      ++rendered;
    }
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(order.size()));
  }
  const std::uint32_t missing = folder.missing();
  if (missing == 0) {
    renderer.load(views.front());
    finish(arguments, views, folder, renderer.scene());
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  report(arguments, rendered, order.size() - rendered, missing, seconds.count());
}

}  // namespace microtrace::cli
