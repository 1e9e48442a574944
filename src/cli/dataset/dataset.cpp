#include "cli/dataset/dataset.hpp"

#include "base/counted.hpp"
#include "base/text/printable.hpp"
#include "cli/dataset/plan.hpp"
#include "cli/pictures/exposure.hpp"
#include "cli/pictures/render_picture.hpp"

#include <microtrace/dataset.hpp>
#include <microtrace/read_files.hpp>
#include <microtrace/version.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <optional>
#include <set>
#include <string>
#include <system_error>
#include <tuple>
#include <variant>

namespace microtrace::cli {
namespace {

/// Calls f(i) for the first view with each variant and environment.
template <class F>
void for_each_look(const std::vector<DatasetView>& views, const F& f) {
  std::set<std::tuple<std::optional<std::string>, std::optional<std::string>>> looks;
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    if (looks.emplace(views[i].variant, views[i].environment).second) f(i);
  }
}

namespace fs = std::filesystem;

[[noreturn]] void refuse_shared_name(const std::string& name, const std::string& reason = "") {
  refuse_usage("--name: " + reason + "views share the file name " + name +
               "; add {view:06d} or give the views different names");
}

/// Throws Error (usage) if two views would have files with the same name, or a view those of other
/// files of the data set.
void check_names(const Arguments& arguments, const std::vector<DatasetView>& views) {
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    const std::string name = stem_of(arguments, views[i], i);
    const fs::path path = fs::path(name).lexically_normal();
    if (!path.has_filename())
      refuse_usage("--name: a view has no file name; add {view:06d} or give the views names");
    for (const char* folder : {"records", "annotations", "bop"}) {
      if (*path.begin() == folder && path.has_parent_path())
        refuse_usage("--name: the folder " + std::string(folder) +
                     " is for other files of the data set; name another one");
    }
    if (!names.insert(name).second) refuse_shared_name(name);
  }
}

/// Throws Error (usage) if two views would have the same files in a folder that ignores the case of
/// letters.
void check_case(const fs::path& folder, const Arguments& arguments,
                const std::vector<DatasetView>& views) {
  std::error_code error;
  if (!fs::exists(folder / "DATASET.JSON", error)) return;
  std::set<std::string> names;
  for (std::uint32_t i = 0; i < views.size(); ++i) {
    std::string name = stem_of(arguments, views[i], i);
    for (char& c : name) c = 'A' <= c && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    if (!names.insert(name).second)
      refuse_shared_name(name, folder.string() + " ignores the case of letters, so ");
  }
}

DatasetIdentity identity_of(const Arguments& arguments, const std::vector<DatasetView>& views,
                            std::uint64_t digest, const std::string& denoiser) {
  std::error_code ignored;  // the folder may have been removed
  std::string program = "microtrace " MICROTRACE_VERSION_TEXT;
  if (!denoiser.empty()) program += " with " + denoiser;
  return {.program = program,
          .scene = fs::path(arguments.scene).filename().string(),
          .digest = digest,
          .options = arguments.dataset.identity,
          .views = static_cast<std::uint32_t>(views.size()),
          .folder = fs::current_path(ignored).string(),
          .arguments = arguments.dataset.command_line};
}

void report(const Arguments& arguments, std::size_t rendered, std::size_t kept,
            std::uint32_t missing, double seconds) {
  if (arguments.quiet || arguments.progress == Progress::json) return;
  std::fprintf(stderr, "%s: rendered %s in %.1f s", printable(arguments.output.string()).c_str(),
               counted(rendered, "view").c_str(), seconds);
  if (kept > 0) std::fprintf(stderr, ", kept %zu", kept);
  if (missing > 0) {
    std::fprintf(stderr, "; %s of other shards %s not rendered yet",
                 counted(missing, "view").c_str(), missing == 1 ? "is" : "are");
  }
  std::fprintf(stderr, "\n");
}

}  // namespace

Dataset::Dataset(const Arguments& arguments, std::vector<Diagnostic>* warnings,
                 const Locate& locate)
    : arguments_(arguments), warnings_(arguments, warnings) {
  if (arguments.scene == "-") refuse_usage("SCENE: a data set needs a file, not standard input");
  if (arguments.output == "-")
    refuse_usage("--output: a data set is a folder, which can't be standard output");
  refuse_automatic_exposure(arguments_.display, "dataset");
  const ReadDigest digest;
  views_ = views_of(arguments_);
  for (DatasetView& view : views_) {
    if (locate && view.environment) view.environment = locate(*view.environment);
  }
  check_names(arguments_, views_);
  renderer_.emplace(arguments_, warnings_);
  renderer_->load(views_.front());  // the same view in all shards, so that the digests agree
  std::set<std::string> cameras;    // each name is checked once
  for (std::uint32_t i = 0; i < views_.size(); ++i) {
    const auto* name = std::get_if<std::string>(&views_[i].camera);
    if (name == nullptr || cameras.insert(*name).second) renderer_->check_camera(views_[i], i);
  }
  for_each_look(views_, [&](std::uint32_t i) { renderer_->check_look(views_[i], i); });
  identity_ = identity_of(arguments_, views_, digest.value(), renderer_->denoiser());
  if (!writes(arguments_, DatasetFormat::bop)) return;
  // Refuses most poses that BOP can't describe before the folder is made. The others are refused
  // later, because to pose all frames of a large scene takes long.
  const std::vector<std::uint32_t> order = rendering_order(views_, std::nullopt);
  for (const std::size_t i : {order.size() / 2, order.size() - 1})
    renderer_->load(views_[order[i]]);
}

std::vector<std::uint32_t> Dataset::order() const {
  return rendering_order(views_, arguments_.dataset.shard);
}

DatasetFolder Dataset::create(const fs::path& path) const {
  DatasetFolder folder(path, identity_);
  check_case(path, arguments_, views_);
  return folder;
}

void Dataset::read_all() {
  for_each_look(views_, [&](std::uint32_t i) { renderer_->load(views_[i]); });
}

std::vector<std::string> Dataset::render(DatasetFolder& folder, std::uint32_t view) {
  std::vector<std::string> names = renderer_->render(views_.at(view), view, folder.path());
  folder.finish(view, names);
  return names;
}

std::vector<std::string> Dataset::finish(const DatasetFolder& folder) {
  renderer_->load(views_.front());
  const Scene& scene = renderer_->scene();
  const auto parts = [&](DatasetFormat format) {
    std::vector<fs::path> paths;
    for (std::uint32_t view = 0; view < views_.size(); ++view)
      paths.push_back(folder.path() / annotations_name(arguments_, views_[view], view, format));
    return paths;
  };
  std::vector<std::string> more;
  if (writes(arguments_, DatasetFormat::coco)) {
    more.emplace_back("coco.json");
    join_coco(parts(DatasetFormat::coco), scene, arguments_.dataset.coco.categories,
              folder.path() / more.back());
  }
  if (writes(arguments_, DatasetFormat::bop)) {
    std::error_code error;  // writing the files reports failures
    fs::create_directories(folder.path() / kBopScene, error);
    join_bop(parts(DatasetFormat::bop), folder.path() / kBopScene);
    for (const char* name : {"scene_camera.json", "scene_gt.json", "scene_gt_info.json"})
      more.push_back(std::string(kBopScene) + name);
    for (const NamedFile& file : bop_models(scene)) {
      more.push_back("bop/" + file.name);
      write_dataset_file(folder.path() / more.back(), file.bytes);
    }
  }
  folder.write_manifest(more);
  more.emplace_back("manifest.json");
  return more;
}

void write_dataset(const Arguments& arguments) {
  const auto begin = std::chrono::steady_clock::now();
  Dataset dataset(arguments);
  const std::vector<std::uint32_t> order = dataset.order();
  DatasetFolder folder = dataset.create(arguments.output);
  const auto progress = progress_of(arguments, static_cast<std::uint32_t>(order.size()));
  std::size_t rendered = 0, kept = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (folder.is_whole(order[i])) {
      ++kept;
    } else {
      dataset.render(folder, order[i]);
      ++rendered;
    }
    if (progress) progress(static_cast<double>(i + 1) / static_cast<double>(order.size()));
  }
  const std::uint32_t missing = folder.missing();
  if (missing != 0 && !arguments.dataset.shard) {
    throw Error(ErrorKind::io, (folder.path() / "records").string(),
                "lacks the records of " + counted(missing, "view") +
                    " that were rendered; run the same command again");
  }
  // The files of a finished data set may be another user's, and read-only.
  if (missing == 0 && (rendered != 0 || !folder.is_finished())) {
    // A power failure can damage the files of shards that have ended.
    for (const std::uint32_t view : folder.damaged(&is_annotations)) {
      dataset.render(folder, view);
      ++rendered;
    }
    dataset.finish(folder);
  }
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  report(arguments, rendered, kept, missing, seconds.count());
}

}  // namespace microtrace::cli
