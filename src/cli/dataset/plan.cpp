#include "cli/dataset/plan.hpp"

#include "base/memory_account.hpp"

#include <algorithm>
#include <string_view>
#include <tuple>
#include <variant>

namespace microtrace::cli {
namespace {

constexpr std::uint32_t kMaxViews = 10'000'000;

auto scene_key(const DatasetView& view) {
  return std::tie(view.variant, view.time, view.environment, view.environment_rotation,
                  view.environment_intensity);
}

/// Throws Error (limit) if so many views exceed the memory limit.
void check_memory(const Arguments& arguments, std::uint64_t views) {
  constexpr std::uint64_t kNameSize = 128;  // approximate size of a view's name in tables
  MemoryBudget budget(arguments.memory_limit.value_or(default_memory_limit()));
  MemoryAccount memory(&budget);
  const MemoryScope scope(memory);
  take_memory(views * (sizeof(DatasetView) + kNameSize), "the views of the data set");
}

/// Returns the generator that --views names, or an empty text.
std::string_view generator_of(const Arguments& arguments) {
  const std::string_view text = arguments.dataset.views;
  const std::string_view kind = text.substr(0, std::min(text.find(':'), text.size()));
  const bool is_generated = kind == "orbit" || kind == "hemisphere" || kind == "random";
  return is_generated && kind.size() < text.size() ? kind : std::string_view();
}

/// The views of --views without --frames.
std::vector<DatasetView> listed_views(const Arguments& arguments) {
  const std::string& text = arguments.dataset.views;
  if (text.empty()) return {DatasetView{}};
  const std::string_view kind = generator_of(arguments);
  if (kind.empty()) {
    MemoryBudget budget(arguments.memory_limit.value_or(default_memory_limit()));
    MemoryAccount memory(&budget);
    const MemoryScope scope(memory);
    return read_views(text, arguments.size);
  }
  const std::vector<double> numbers = numbers_of(std::string_view(text).substr(kind.size() + 1));
  const bool is_count = !numbers.empty() && numbers[0] >= 1 && numbers[0] <= kMaxViews &&
                        numbers[0] == static_cast<std::uint32_t>(numbers[0]);
  const std::size_t most = kind == "orbit" ? 2 : 1;
  if (!is_count || numbers.size() > most ||
      (numbers.size() == 2 && !(numbers[1] >= -90 && numbers[1] <= 90))) {
    OptionValue{.option = "--views", .text = text}.refuse(
        "a file, orbit:N, orbit:N,ELEVATION (-90 to 90 degrees), hemisphere:N or random:N, with N "
        "from 1 to " +
        std::to_string(kMaxViews));
  }
  const auto count = static_cast<std::uint32_t>(numbers[0]);
  check_memory(arguments, count);
  std::vector<DatasetView> views;
  if (kind == "orbit") views = orbit_views(count, numbers.size() == 2 ? numbers[1] : 25);
  if (kind == "hemisphere") views = hemisphere_views(count);
  if (kind == "random") views = random_views(count, arguments.sampling.seed);
  for (DatasetView& view : views)
    std::get<View>(view.camera).vertical_fov = arguments.camera.view().vertical_fov;
  return views;
}

/// Refuses options that none of the views uses.
void check_use(const Arguments& arguments, const std::vector<DatasetView>& views) {
  const CameraOptions& camera = arguments.camera;
  const bool any_lacks_camera = std::ranges::any_of(views, [](const DatasetView& view) {
    const auto* name = std::get_if<std::string>(&view.camera);
    return name != nullptr && name->empty();
  });
  if (!any_lacks_camera && (!camera.camera.empty() || !camera.is_of_scene()))
    refuse_usage("--camera, --view and --eye are for views without a camera, but all have one");
  if (camera.vertical_fov && camera.is_of_scene() && generator_of(arguments).empty())
    refuse_usage("--fov requires --view, --eye or generated views");
  const bool any_is_framed = std::ranges::any_of(
      views, [](const DatasetView& view) { return std::holds_alternative<View>(view.camera); });
  if ((camera.lens_radius || camera.focus) && !any_lacks_camera && !any_is_framed)
    refuse_usage(
        "--aperture and --focus are for views without a camera and for those that frame "
        "the scene; set the lens of the cameras in the list of views");
  if (arguments.size &&
      std::ranges::all_of(views, [](const DatasetView& view) { return view.size.has_value(); }))
    refuse_usage("--size is for views without a size, but all have one");
  const bool any_has_time =
      std::ranges::any_of(views, [](const DatasetView& view) { return view.time.has_value(); });
  if (!arguments.load.animation.empty() && !arguments.load.time && !any_has_time)
    refuse_usage("--animation requires --time, --frames or views with times");
}

/// Refuses options of formats that are not written.
void check_formats(const Arguments& arguments) {
  const DatasetOptions& dataset = arguments.dataset;
  if (!writes(arguments, DatasetFormat::coco)) {
    if (dataset.coco.amodal) refuse_usage("--amodal is for the format coco; add it to --formats");
    if (dataset.coco.categories != DatasetOptions{}.coco.categories)
      refuse_usage("--categories is for the format coco; add it to --formats");
  }
  if (!arguments.aovs.empty() && !writes(arguments, DatasetFormat::exr) &&
      !writes(arguments, DatasetFormat::npz))
    refuse_usage("--aov is for the formats exr and npz; add one of them to --formats");
  if (dataset.depth_scale != DatasetOptions{}.depth_scale && !writes(arguments, DatasetFormat::bop))
    refuse_usage("--depth-scale is for the format bop; add it to --formats");
}

std::vector<DatasetView> views_of_frames(const Arguments& arguments,
                                         const std::vector<DatasetView>& listed) {
  if (std::uint64_t{listed.size()} * arguments.frames->count() > kMaxViews)
    refuse_usage("--frames: more than " + std::to_string(kMaxViews) + " views in all");
  check_memory(arguments, std::uint64_t{listed.size()} * arguments.frames->count());
  std::vector<DatasetView> views;
  for (std::uint32_t i = 0; i < arguments.frames->count(); ++i) {
    for (DatasetView view : listed) {
      if (view.time) refuse_usage("--frames: the views of --views already have times");
      view.time = arguments.frames->time(arguments.frames->first + i);
      views.push_back(std::move(view));
    }
  }
  return views;
}

}  // namespace

std::vector<DatasetView> views_of(const Arguments& arguments) {
  std::vector<DatasetView> views = listed_views(arguments);
  if (arguments.frames) views = views_of_frames(arguments, views);
  check_use(arguments, views);
  check_formats(arguments);
  return views;
}

ImageSize size_of(const Arguments& arguments, const DatasetView& view, const Scene& scene) {
  if (view.size) return *view.size;
  if (arguments.size) return *arguments.size;
  const auto* camera = std::get_if<Camera>(&view.camera);
  const auto* calibrated = camera != nullptr ? std::get_if<CalibratedCamera>(camera) : nullptr;
  return calibrated != nullptr ? calibrated->image : scene.size;
}

std::string stem_of(const Arguments& arguments, const DatasetView& view, std::uint32_t index) {
  return dataset_file_name(arguments.dataset.name,
                           std::filesystem::path(arguments.scene).stem().string(), index,
                           view.name);
}

constexpr std::string_view kAnnotations = "annotations/";

bool is_annotations(const std::string& name) {
  return name.starts_with(kAnnotations);
}

std::string annotations_name(const Arguments& arguments, const DatasetView& view,
                             std::uint32_t index, DatasetFormat format) {
  return std::string(kAnnotations) + stem_of(arguments, view, index) +
         (format == DatasetFormat::bop ? ".bop.txt" : ".coco.txt");
}

std::string picture_name(const Arguments& arguments, const DatasetView& view, std::uint32_t index) {
  const std::string stem = stem_of(arguments, view, index);
  if (writes(arguments, DatasetFormat::png)) return stem + ".png";
  if (writes(arguments, DatasetFormat::exr)) return stem + ".exr";
  if (writes(arguments, DatasetFormat::npz)) return stem + ".npz";
  return writes(arguments, DatasetFormat::bop) ? bop_picture_name(index) : "";
}

std::string bop_picture_name(std::uint32_t index) {
  return kBopScene + dataset_file_name("rgb/{view:06d}.png", "", index, "");
}

bool writes(const Arguments& arguments, DatasetFormat format) {
  const std::vector<DatasetFormat>& formats = arguments.dataset.formats;
  return std::ranges::find(formats, format) != formats.end();
}

std::vector<std::uint32_t> rendering_order(const std::vector<DatasetView>& views,
                                           const std::optional<Shard>& shard) {
  const Shard part = shard.value_or(Shard{});
  std::vector<std::uint32_t> order(views.size());
  for (std::uint32_t i = 0; i < views.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return scene_key(views[a]) < scene_key(views[b]);
  });
  const auto bound = [&](std::uint64_t index) {
    return static_cast<std::ptrdiff_t>(order.size() * index / part.count);
  };
  // A shard's views follow each other in this order, so that they share preparations too.
  return {order.begin() + bound(part.index - 1), order.begin() + bound(part.index)};
}

bool share_scene(const DatasetView& a, const DatasetView& b) {
  return scene_key(a) == scene_key(b);
}

}  // namespace microtrace::cli
