#pragma once
/// The part of the C interface of Open Image Denoise 2 that microtrace uses, as its documentation
/// describes it. The library's own header is not needed.

#include <cstddef>

extern "C" {

struct OidnDevice;
struct OidnFilter;

using OidnProgress = bool (*)(void* context, double share);

/// Pointers to the library's functions, named like these without "oidn".
struct OidnFunctions {
  OidnDevice* (*new_device)(int type);
  void (*set_device_int)(OidnDevice*, const char* name, int value);
  void (*set_device_bool)(OidnDevice*, const char* name, bool value);
  int (*get_device_int)(OidnDevice*, const char* name);
  void (*commit_device)(OidnDevice*);
  /// Returns the first error since the last call. A null device stands for errors of new_device.
  int (*get_device_error)(OidnDevice*, const char** message);
  void (*release_device)(OidnDevice*);
  OidnFilter* (*new_filter)(OidnDevice*, const char* type);
  /// Strides in bytes; 0 if the pixels are packed.
  void (*set_shared_filter_image)(OidnFilter*, const char* name, void* pixels, int format,
                                  std::size_t width, std::size_t height, std::size_t offset,
                                  std::size_t pixel_stride, std::size_t row_stride);
  void (*set_filter_bool)(OidnFilter*, const char* name, bool value);
  void (*set_filter_int)(OidnFilter*, const char* name, int value);
  void (*set_filter_progress_monitor_function)(OidnFilter*, OidnProgress progress, void* context);
  void (*commit_filter)(OidnFilter*);
  void (*execute_filter)(OidnFilter*);
  void (*release_filter)(OidnFilter*);
};
}

namespace microtrace::oidn {

inline constexpr char kFileName[] = "libOpenImageDenoise.so.2";
inline constexpr int kCpu = 1;     ///< a device type
inline constexpr int kFloat3 = 3;  ///< an image format
// Errors:
inline constexpr int kOutOfMemory = 4, kCanceled = 6;

}  // namespace microtrace::oidn
