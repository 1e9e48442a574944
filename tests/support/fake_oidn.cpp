/// Stands for Open Image Denoise in tests, which thus don't depend on its installation. The filter
/// averages each pixel of an image with its right neighbor. The environment variable FAKE_OIDN
/// names a failure: "memory", "broken" or "processor"; "same" makes the filter copy the image.
/// If it is "noisy", features must be filtered before the colors, and the filter adds 1/64 to the
/// colors; otherwise, features must not be filtered.

#include "denoise/oidn_abi.hpp"

#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <vector>

struct OidnDevice {
  int error = 0;
  std::string message{};
  std::set<const float*> filtered{};  ///< features
};

struct OidnFilter {
  OidnDevice* device;
  std::map<std::string, float*> images{};
  std::map<std::string, bool> switches{};
  std::size_t width = 0, height = 0;
  OidnProgress progress = nullptr;
  void* context = nullptr;
};

namespace {

bool has_mode(const char* mode) {
  const char* given = std::getenv("FAKE_OIDN");
  return given != nullptr && std::strcmp(given, mode) == 0;
}

void fail(OidnDevice* device, int error, const char* message) {
  device->error = error;
  device->message = message;
}

}  // namespace

#define FAKE extern "C" __attribute__((visibility("default")))

FAKE OidnDevice* oidnNewDevice(int type) {
  return type == 1 && !has_mode("processor") ? new OidnDevice : nullptr;
}
FAKE void oidnSetDeviceInt(OidnDevice* device, const char* name, int value) {
  if (std::strcmp(name, "numThreads") != 0 || value < 1) fail(device, 2, "numThreads is wrong");
}
FAKE void oidnSetDeviceBool(OidnDevice* device, const char* name, bool value) {
  if (std::strcmp(name, "setAffinity") != 0 || value) fail(device, 2, "setAffinity is wrong");
}
FAKE int oidnGetDeviceInt(OidnDevice*, const char* name) {
  return std::strcmp(name, "versionMajor") == 0   ? 2
         : std::strcmp(name, "versionMinor") == 0 ? 0
                                                  : 7;
}
FAKE void oidnCommitDevice(OidnDevice*) {}
FAKE int oidnGetDeviceError(OidnDevice* device, const char** message) {
  if (device == nullptr) {
    *message = "unsupported hardware";
    return 5;
  }
  *message = device->message.c_str();
  const int error = device->error;
  device->error = 0;
  return error;
}
FAKE void oidnReleaseDevice(OidnDevice* device) {
  delete device;
}
FAKE OidnFilter* oidnNewFilter(OidnDevice* device, const char* type) {
  if (std::strcmp(type, "RT") != 0) fail(device, 2, "the filter's type is unknown");
  return new OidnFilter{.device = device};
}
FAKE void oidnSetSharedFilterImage(OidnFilter* filter, const char* name, void* pixels, int format,
                                   std::size_t width, std::size_t height, std::size_t, std::size_t,
                                   std::size_t) {
  if (format != 3) fail(filter->device, 2, "the format is not float3");
  filter->images[name] = static_cast<float*>(pixels);
  filter->width = width;
  filter->height = height;
}
FAKE void oidnSetFilterBool(OidnFilter* filter, const char* name, bool value) {
  filter->switches[name] = value;
}
FAKE void oidnSetFilterInt(OidnFilter*, const char*, int) {}
FAKE void oidnSetFilterProgressMonitorFunction(OidnFilter* filter, OidnProgress progress,
                                               void* context) {
  filter->progress = progress;
  filter->context = context;
}
FAKE void oidnCommitFilter(OidnFilter*) {}
FAKE void oidnExecuteFilter(OidnFilter* filter) {
  OidnDevice* device = filter->device;
  auto& images = filter->images;
  if (has_mode("memory")) return fail(device, 4, "out of memory");
  if (has_mode("broken")) return fail(device, 1, "made up for a test");
  float* const color = images["color"];
  float* const feature = images["albedo"] != nullptr ? images["albedo"] : images["normal"];
  if (feature == nullptr || images["output"] == nullptr)
    return fail(device, 2, "an image is missing");
  if (color == nullptr) {
    device->filtered.insert(images["output"]);
  } else {
    if (!filter->switches["hdr"] || !filter->switches["cleanAux"])
      return fail(device, 2, "a switch is missing");
    for (const char* name : {"albedo", "normal"}) {
      if (device->filtered.contains(images[name]) != has_mode("noisy"))
        return fail(device, 2, "a feature is noisy, or was filtered without need");
    }
  }
  if (filter->progress != nullptr && !filter->progress(filter->context, 0.5))
    return fail(device, 6, "canceled");
  const float* const input = color != nullptr ? color : feature;
  const std::size_t row = 3 * filter->width;
  const std::vector<float> from(input, input + row * filter->height);
  for (std::size_t i = 0; i < from.size(); ++i) {
    const bool is_last = i % row + 3 >= row;
    images["output"][i] = is_last || has_mode("same") ? from[i] : (from[i] + from[i + 3]) / 2;
    if (color != nullptr && has_mode("noisy")) images["output"][i] += 0x1p-6F;
  }
}
FAKE void oidnReleaseFilter(OidnFilter* filter) {
  delete filter;
}
