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
  /// `window` is the strip.
  CoverCollector(const Camera& camera, const PixelRect& window)
      : camera_(camera), window_(window) {}

  void trace(const World& world, std::span<const Ray> rays, std::span<const SampleId> ids,
             std::span<Sample> samples) const override {
    std::call_once(is_counted_, [&] {
      overlaps_.emplace(
          parts_of_objects(world.bvh.primitives().scene(), camera_, world.camera, window_),
          window_);
    });
    std::vector<Cover> covers;
    std::vector<Ray> single, several;                  // rays that can hit one object, or several
    std::vector<std::uint32_t> of_single, of_several;  // their pixels
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t count = overlaps_->at(ids[i].x, ids[i].y);
      if (count == 0) continue;
      (count == 1 ? single : several).push_back(rays[i]);
      (count == 1 ? of_single : of_several).push_back(pixel_of(ids[i]));
    }
    add_nearest(world, single, of_single, covers);
    add_all(world, several, of_several, covers);
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
  [[nodiscard]] std::uint32_t pixel_of(const SampleId& id) const {
    return (id.y - window_.y0) * (window_.x1 - window_.x0) + (id.x - window_.x0);
  }

  /// Adds the objects that the rays see. All hits of each ray must be on one object.
  static void add_nearest(const World& world, std::span<const Ray> rays,
                          std::span<const std::uint32_t> pixels, std::vector<Cover>& covers) {
    std::vector<std::optional<Hit>> hits(rays.size());
    world.bvh.intersect(rays, hits);
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (hits[i]) hits[i] = world.first_visible(rays[i], hits[i]);
      if (hits[i]) covers.push_back({.object = object_of(world, *hits[i]), .pixel = pixels[i]});
    }
  }

  /// Adds all objects that the rays would see without the others.
  static void add_all(const World& world, std::span<const Ray> rays,
                      std::span<const std::uint32_t> pixels, std::vector<Cover>& covers) {
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
        covers.push_back({.object = *last, .pixel = pixels[i]});
      }
    }
  }

  static std::uint32_t object_of(const World& world, const Hit& hit) {
    return static_cast<std::uint32_t>(world.bvh.primitives().object_index(hit.id));
  }

  const Camera& camera_;
  PixelRect window_;
  mutable std::once_flag is_counted_;
  mutable std::optional<Overlaps> overlaps_;
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
    const PixelRect strip{.x0 = 0, .y0 = y, .x1 = size.width, .y1 = end};
    CoverCollector collector(camera, strip);
    RenderOptions render_options{.threads = options.threads, .run_threads = options.run_threads};
    render_options.integrator = &collector;
    render_options.crop = strip;
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
