#include "dataset/annotations/masks.hpp"

#include "dataset/annotations/overlaps.hpp"

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

/// Finds the pixels in which a ray can hit several objects. It is an integrator, because
/// integrators get the scene that is rendered, which may be translated.
class OverlapFinder final : public Integrator {
 public:
  OverlapFinder(const Camera& camera, ImageSize size)
      : camera_(camera), window_{.x0 = 0, .y0 = 0, .x1 = size.width, .y1 = size.height} {}

  void trace(const World& world, std::span<const Ray> /*rays*/, std::span<const SampleId> /*ids*/,
             std::span<Sample> samples) const override {
    std::ranges::fill(samples, Sample{});
    overlaps_.emplace(
        parts_of_objects(world.bvh.primitives().scene(), camera_, world.camera, window_), window_);
  }

  /// Must be called after one pixel has been rendered.
  [[nodiscard]] const Overlaps& overlaps() const { return overlaps_.value(); }

 private:
  const Camera& camera_;
  PixelRect window_;
  mutable std::optional<Overlaps> overlaps_;
};

/// A pixel, numbered row by row from the first row of the picture, and an object that covers it.
struct Cover {
  std::uint64_t pixel;
  std::uint32_t object;

  [[nodiscard]] auto operator<=>(const Cover&) const = default;
};

void sort_without_duplicates(std::vector<Cover>& covers) {
  std::ranges::sort(covers);
  covers.erase(std::unique(covers.begin(), covers.end()), covers.end());
}

std::uint32_t object_of(const World& world, const Hit& hit) {
  return static_cast<std::uint32_t>(world.bvh.primitives().object_index(hit.id));
}

/// Collects the objects that camera rays hit in pixels in which they can hit several. It is an
/// integrator, so it gets the same rays as the AOVs and treats partly transparent surfaces in the
/// same way.
class CoverCollector final : public Integrator {
 public:
  CoverCollector(const Overlaps& overlaps, ImageSize size) : overlaps_(overlaps), size_(size) {}

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    std::ranges::fill(samples, Sample{});
    std::vector<Ray> asked;
    std::vector<std::uint64_t> pixels;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (overlaps_.at(ids[i].x, ids[i].y) < 2) continue;
      asked.push_back(rays[i]);
      pixels.push_back(std::uint64_t{ids[i].y} * size_.width + ids[i].x);
    }
    std::vector<Cover> covers;
    add_all(world, asked, pixels, covers);
    const std::scoped_lock lock(mutex_);
    covers_.insert(covers_.end(), covers.begin(), covers.end());
  }

  [[nodiscard]] bool is_data() const override { return true; }

  /// Returns all covers so far, in order.
  [[nodiscard]] std::vector<Cover> take() {
    sort_without_duplicates(covers_);
    return std::exchange(covers_, {});
  }

 private:
  /// Adds all objects that the rays would see without the others.
  static void add_all(const World& world, std::span<const Ray> rays,
                      std::span<const std::uint64_t> pixels, std::vector<Cover>& covers) {
    const RayHits all = intersect_all(world.bvh, rays, {.threads = 1});
    for (std::size_t i = 0; i < rays.size(); ++i) {
      std::optional<std::uint32_t> last;  // the previous visible hit's object
      const std::span<const Hit> hits = all.of(i);
      for (auto hit = hits.begin(); hit != hits.end(); ++hit) {
        if (object_of(world, *hit) == last) continue;
        const std::optional<Hit> visible = world.first_visible(rays[i], *hit);
        if (!visible) break;
        hit = std::find_if(hit, hits.end(), [&](const Hit& h) { return h.id == visible->id; });
        if (hit == hits.end()) break;
        last = object_of(world, *hit);
        covers.push_back({.pixel = pixels[i], .object = *last});
      }
    }
  }

  const Overlaps& overlaps_;
  ImageSize size_;
  mutable std::mutex mutex_;
  mutable std::vector<Cover> covers_;
};

/// Adds pixels to the masks of objects. Each object's pixels must be added row by row.
class MaskMaker {
 public:
  void add(std::uint32_t object, std::uint32_t x, std::uint32_t y) {
    if (mask_ == nullptr || object != last_) mask_ = &masks_[object];
    last_ = object;
    mask_->add(x, y);
  }

  /// Returns the masks in the order of the objects.
  [[nodiscard]] Masks take() {
    Masks result;
    result.reserve(masks_.size());
    for (auto& [object, mask] : masks_)
      result.push_back({.object = object, .mask = std::move(mask)});
    return result;
  }

 private:
  std::map<std::uint32_t, Mask> masks_;
  std::uint32_t last_ = kNoObject;
  Mask* mask_ = nullptr;  // of last_
};

void check(const DrawnView& view) {
  if (view.objects.size() != std::size_t{view.size.width} * view.size.height)
    throw Error(ErrorKind::usage, "", "a view needs the index of an object for each of its pixels");
  for (const std::uint32_t object : view.objects) {
    if (object != kNoObject && object >= view.scene->scene().objects.size())
      throw Error(ErrorKind::usage, "", "the scene has no object " + std::to_string(object));
  }
}

}  // namespace

const Mask* find_mask(const Masks& masks, std::uint32_t object) {
  const auto found = std::ranges::lower_bound(masks, object, {}, &ObjectMask::object);
  return found != masks.end() && found->object == object ? &found->mask : nullptr;
}

Masks visible_masks(const DrawnView& view) {
  check(view);
  MaskMaker masks;
  std::size_t pixel = 0;
  for (std::uint32_t y = 0; y < view.size.height; ++y) {
    for (std::uint32_t x = 0; x < view.size.width; ++x) {
      const std::uint32_t object = view.objects[pixel++];
      if (object != kNoObject) masks.add(object, x, y);
    }
  }
  return masks.take();
}

Masks amodal_masks(const DrawnView& view, const QueryOptions& options) {
  check(view);
  const ImageSize size = view.size;
  RenderOptions render_options{.threads = options.threads, .run_threads = options.run_threads};
  const OverlapFinder finder(*view.camera, size);
  render_options.integrator = &finder;
  render_options.crop = PixelRect{.x0 = 0, .y0 = 0, .x1 = 1, .y1 = 1};
  static_cast<void>(render(*view.scene, *view.camera, size, render_options));
  const Overlaps& overlaps = finder.overlaps();
  const PixelRect& several = overlaps.several();

  CoverCollector collector(overlaps, size);
  render_options.integrator = &collector;
  constexpr std::uint32_t kPixels = 1U << 16, kTile = 8;
  const std::uint32_t rows = std::max(kTile, kPixels / std::max(size.width, 1U) / kTile * kTile);
  MaskMaker masks;
  std::size_t pixel = 0;
  for (std::uint32_t y0 = 0; y0 < size.height;) {
    const std::uint32_t y1 = y0 + std::min(rows, size.height - y0);
    if (options.progress) {
      render_options.progress = [&](double done) {
        return options.progress((y0 + done * (y1 - y0)) / size.height);
      };
    }
    const PixelRect traced{.x0 = several.x0,
                           .y0 = std::max(y0, several.y0),
                           .x1 = several.x1,
                           .y1 = std::min(y1, several.y1)};
    std::vector<Cover> covers;
    if (traced.x0 < traced.x1 && traced.y0 < traced.y1) {
      render_options.crop = traced;
      static_cast<void>(render(*view.scene, *view.camera, size, render_options));
      covers = collector.take();
    } else if (options.progress && !options.progress(static_cast<double>(y1) / size.height)) {
      throw Error(ErrorKind::canceled, "", "canceled");
    }
    auto cover = covers.begin();
    for (std::uint32_t y = y0; y < y1; ++y) {
      for (std::uint32_t x = 0; x < size.width; ++x, ++pixel) {
        if (overlaps.at(x, y) < 2) {
          // Without another object that could hide it, the object is visible.
          if (view.objects[pixel] != kNoObject) masks.add(view.objects[pixel], x, y);
        } else {
          for (; cover != covers.end() && cover->pixel == pixel; ++cover)
            masks.add(cover->object, x, y);
        }
      }
    }
    y0 = y1;
  }
  return masks.take();
}

}  // namespace microtrace::dataset
