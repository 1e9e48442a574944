#include "denoise/library.hpp"

#include "io/elf_file.hpp"
#include "io/module_folders.hpp"

#include <microtrace/error.hpp>

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <link.h>
#include <system_error>
#include <utility>

namespace microtrace {
namespace {

namespace fs = std::filesystem;

constexpr const char* kVariable = "MICROTRACE_OIDN_PATH";

[[noreturn]] void refuse_denoising(const std::string& reason) {
  throw Error(ErrorKind::unsupported, "",
              "pictures can't be denoised: " + reason +
                  "; get Open Image Denoise 2 by `pip install --no-deps --target ~/oidn pyoidn` "
                  "and set MICROTRACE_OIDN_PATH=~/oidn/pyoidn/oidn/lib");
}

std::string linker_complaint() {
  const char* reason = ::dlerror();
  return reason != nullptr ? reason : "it can't be loaded";
}

void* load_file(const fs::path& path) {
  if (const std::string damage = io::damage_of_elf_file(path); !damage.empty())
    refuse_denoising(path.string() + " can't be used: " + damage);
  void* handle = ::dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (handle == nullptr) refuse_denoising(linker_complaint());
  return handle;
}

bool is_there(const fs::path& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// Loads the library from the place that the user named.
void* load_named(const fs::path& named) {
  std::error_code ignored;
  const fs::path path = fs::is_directory(named, ignored) ? named / oidn::kFileName : named;
  if (!is_there(path))
    refuse_denoising(path.string() + ", named by " + kVariable + ", does not exist");
  return load_file(path);
}

void* load_denoiser() {
  if (const char* named = std::getenv(kVariable); named != nullptr && *named != 0)
    return load_named(named);
  std::string searched;
  for (const fs::path& folder : io::module_folders()) {
    if (is_there(folder / oidn::kFileName)) return load_file(folder / oidn::kFileName);
    searched += folder.string() + " and ";
  }
  if (void* handle = ::dlopen(oidn::kFileName, RTLD_NOW | RTLD_LOCAL)) return handle;
  refuse_denoising(std::string(oidn::kFileName) + " is not in " + searched +
                   "the dynamic linker's folders");
}

std::string path_of(void* library) {
  const link_map* map = nullptr;
  return ::dlinfo(library, RTLD_DI_LINKMAP, static_cast<void*>(&map)) == 0 ? map->l_name
                                                                           : "the library";
}

template <class Function>
void find_denoiser_function(void* library, const char* name, Function*& function) {
  function = reinterpret_cast<Function*>(::dlsym(library, name));
  if (function == nullptr)
    refuse_denoising(path_of(library) + " lacks " + name + ", so it is another library or version");
}

OidnFunctions functions_of(void* library) {
  OidnFunctions f{};
  find_denoiser_function(library, "oidnNewDevice", f.new_device);
  find_denoiser_function(library, "oidnSetDeviceInt", f.set_device_int);
  find_denoiser_function(library, "oidnSetDeviceBool", f.set_device_bool);
  find_denoiser_function(library, "oidnGetDeviceInt", f.get_device_int);
  find_denoiser_function(library, "oidnCommitDevice", f.commit_device);
  find_denoiser_function(library, "oidnGetDeviceError", f.get_device_error);
  find_denoiser_function(library, "oidnReleaseDevice", f.release_device);
  find_denoiser_function(library, "oidnNewFilter", f.new_filter);
  find_denoiser_function(library, "oidnSetSharedFilterImage", f.set_shared_filter_image);
  find_denoiser_function(library, "oidnSetFilterBool", f.set_filter_bool);
  find_denoiser_function(library, "oidnSetFilterInt", f.set_filter_int);
  find_denoiser_function(library, "oidnSetFilterProgressMonitorFunction",
                         f.set_filter_progress_monitor_function);
  find_denoiser_function(library, "oidnCommitFilter", f.commit_filter);
  find_denoiser_function(library, "oidnExecuteFilter", f.execute_filter);
  find_denoiser_function(library, "oidnReleaseFilter", f.release_filter);
  return f;
}

}  // namespace

oidn::Device oidn::open_device(const OidnFunctions& functions, unsigned threads) {
  Device device(functions.new_device(kCpu), {&functions});
  if (device) {
    functions.set_device_int(device.get(), "numThreads", static_cast<int>(threads));
    functions.set_device_bool(device.get(), "setAffinity", false);
    functions.commit_device(device.get());
  }
  const char* message = nullptr;
  if (functions.get_device_error(device.get(), &message) != 0)
    refuse_denoising(std::string("the library reports: ") + message);
  if (!device) refuse_denoising("the library doesn't support this processor");
  return device;
}

// The library is never unloaded, because it may have started threads.
Denoiser::Library::Library() : functions(functions_of(load_denoiser())) {
  const oidn::Device device = oidn::open_device(functions, 1);
  const auto number = [&](const char* name) {
    return std::to_string(functions.get_device_int(device.get(), name));
  };
  version = number("versionMajor") + "." + number("versionMinor") + "." + number("versionPatch");
}

}  // namespace microtrace
