#include "dataset/annotations/masks.hpp"

#include <microtrace/error.hpp>
#include <microtrace/integrator.hpp>
#include <microtrace/primitives.hpp>
#include <microtrace/render.hpp>

#include <algorithm>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace microtrace::dataset {
namespace {

/// A pixel, and an object that covers it. Pixels are numbered row by row from the first row of a
/// strip.
struct Cover {
  std::uint32_t object, pixel;

  [[nodiscard]] auto operator<=>(const Cover&) const = default;
};

void sort_without_duplicates(std::vector<Cover>& covers) {
  std::ranges::sort(covers);
  covers.erase(std::unique(covers.begin(), covers.end()), covers.end());
}

/// Collects the objects that the camera rays of a strip of the picture hit. It is an integrator, so
/// it gets the same rays as the AOVs and treats partly transparent surfaces in the same way.
class CoverCollector final : public Integrator {
 public:
  CoverCollector(std::uint32_t width, std::uint32_t first_row)
      : width_(width), first_row_(first_row) {}

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    const RayHits all = intersect_all(world.bvh, rays, {.threads = 1});
    std::vector<Cover> covers;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t pixel = (ids[i].y - first_row_) * width_ + ids[i].x;
      std::optional<std::size_t> last;  // the previous visible hit's object
      const std::span<const Hit> hits = all.of(i);
      for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
        const std::size_t object = world.bvh.primitives().object_index(hit->id);
        if (object == last) continue;
        const std::optional<Hit> visible = world.first_visible(rays[i], *hit);
        if (!visible) break;
        hit = std::find_if(hit, hits.end(), [&](const Hit& h) { return h.id == visible->id; });
        if (hit == hits.end()) break;
        last = world.bvh.primitives().object_index(hit->id);
        covers.push_back({.object = static_cast<std::uint32_t>(*last), .pixel = pixel});
      }
    }
    sort_without_duplicates(covers);
    std::ranges::fill(samples, Sample{});
    const std::scoped_lock lock(mutex_);
    covers_.insert(covers_.end(), covers.begin(), covers.end());
  }

  [[nodiscard]] bool is_data() const override { return true; }

  /// Returns all covers so far, in order.
  [[nodiscard]] std::vector<Cover> take() {
    sort_without_duplicates(covers_);
    return std::move(covers_);
  }

 private:
  std::uint32_t width_, first_row_;
  mutable std::mutex mutex_;
  mutable std::vector<Cover> covers_;
};

Masks in_order(std::map<std::uint32_t, Mask>&& masks) {
  Masks result;
  result.reserve(masks.size());
  for (auto& [object, mask] : masks) result.push_back({.object = object, .mask = std::move(mask)});
  return result;
}

}  // namespace

const Mask* find_mask(const Masks& masks, std::uint32_t object) {
  const auto found = std::ranges::lower_bound(masks, object, {}, &ObjectMask::object);
  return found != masks.end() && found->object == object ? &found->mask : nullptr;
}

Masks visible_masks(const DrawnView& view) {
  if (view.objects.size() != std::size_t{view.size.width} * view.size.height)
    throw Error(ErrorKind::usage, view.name,
                "a view needs the index of an object for each of its pixels");
  std::map<std::uint32_t, Mask> masks;
  std::uint32_t last = kNoObject;
  Mask* mask = nullptr;  // of `last`
  std::size_t pixel = 0;
  for (std::uint32_t y = 0; y < view.size.height; ++y) {
    for (std::uint32_t x = 0; x < view.size.width; ++x) {
      const std::uint32_t object = view.objects[pixel++];
      if (object == kNoObject) continue;
      if (object != last) {
        if (object >= view.scene->scene().objects.size())
          throw Error(ErrorKind::usage, view.name,
                      "the scene has no object " + std::to_string(object));
        mask = &masks[object];
      }
      last = object;
      mask->add(x, y);
    }
  }
  return in_order(std::move(masks));
}

Masks amodal_masks(const PreparedScene& scene, const Camera& camera, ImageSize size,
                   const QueryOptions& options) {
  constexpr std::uint32_t kPixels = 1U << 16, kTile = 8;
  const std::uint32_t rows = std::max(kTile, kPixels / std::max(size.width, 1U) / kTile * kTile);
  std::map<std::uint32_t, Mask> masks;
  for (std::uint32_t y = 0; y < size.height;) {
    const std::uint32_t end = y + std::min(rows, size.height - y);
    CoverCollector collector(size.width, y);
    RenderOptions render_options{.threads = options.threads, .run_threads = options.run_threads};
    render_options.integrator = &collector;
    render_options.crop = PixelRect{.x0 = 0, .y0 = y, .x1 = size.width, .y1 = end};
    if (options.progress) {
      render_options.progress = [&](double done) {
        return options.progress((y + done * (end - y)) / size.height);
      };
    }
    static_cast<void>(render(scene, camera, size, render_options));
    std::uint32_t last = kNoObject;
    Mask* mask = nullptr;  // of `last`
    for (const Cover& cover : collector.take()) {
      if (cover.object != last) mask = &masks[cover.object];
      last = cover.object;
      mask->add(cover.pixel % size.width, y + cover.pixel / size.width);
    }
    y = end;
  }
  return in_order(std::move(masks));
}

}  // namespace microtrace::dataset
