#pragma once
/// Finds and loads Open Image Denoise.

#include "denoise/oidn_abi.hpp"

#include <microtrace/denoise.hpp>

#include <memory>
#include <string>

namespace microtrace {

struct Denoiser::Library {
  /// Throws Error (unsupported).
  Library();

  OidnFunctions functions{};
  std::string version{};  ///< such as "2.3.2"
};

namespace oidn {

struct DeleteDevice {
  const OidnFunctions* functions;
  void operator()(OidnDevice* device) const { functions->release_device(device); }
};
using Device = std::unique_ptr<OidnDevice, DeleteDevice>;

/// A device that uses the processor. Throws Error (unsupported) if the processor lacks features
/// that the library needs.
[[nodiscard]] Device open_device(const OidnFunctions& functions, unsigned threads);

struct DeleteFilter {
  const OidnFunctions* functions;
  void operator()(OidnFilter* filter) const { functions->release_filter(filter); }
};
using Filter = std::unique_ptr<OidnFilter, DeleteFilter>;

}  // namespace oidn
}  // namespace microtrace
