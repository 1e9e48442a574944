#pragma once
/// Runs the filters of Open Image Denoise.

#include "denoise/library.hpp"

#include <microtrace/film.hpp>
#include <microtrace/math.hpp>
#include <microtrace/render.hpp>

#include <atomic>
#include <cstdint>
#include <exception>
#include <functional>
#include <initializer_list>
#include <vector>

namespace microtrace {

/// The library divides larger pictures into parts, so that it needs no more memory than this. The
/// limit is constant, because it affects the result.
inline constexpr std::uint64_t kMostMegabytes = 1000;

/// The images of a picture, in rows of its width.
struct Images {
  std::vector<Vec3> color, albedo, normal;
};

/// Passes calls of the library on to a progress function, whose exceptions must not propagate
/// through the library's frames.
struct ProgressMonitor {
  const std::function<bool(double)>& progress;
  std::atomic<bool> is_canceled = false;
  std::exception_ptr thrown{};

  static bool goes_on(void* context, double share);
};

/// Runs the library's filters on images of one size.
class Filters {
 public:
  /// The arguments must outlive this object.
  Filters(const OidnFunctions& functions, ImageSize size, const RenderOptions& options);

  /// Replaces the colors by denoised ones. The features must be free of noise.
  void filter_colors(Images& images) {
    run({{"color", images.color}, {"albedo", images.albedo}, {"normal", images.normal}});
  }

  /// Replaces a feature, the library's "albedo" or "normal", by a denoised one.
  void filter_feature(const char* name, std::vector<Vec3>& pixels) { run({{name, pixels}}); }

 private:
  struct NamedImage {
    const char* name;
    std::vector<Vec3>& pixels;
  };

  /// Replaces the first image. The others are its guides.
  void run(std::initializer_list<NamedImage> images);
  /// Throws the error of the last filter, if it failed.
  void check();

  const OidnFunctions& f_;
  ImageSize size_;
  ProgressMonitor monitor_;
  oidn::Device device_;
};

}  // namespace microtrace
