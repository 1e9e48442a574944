#include "io/image/module.hpp"

#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"
#include "io/image/encode/lack_of_memory.hpp"
#include "io/image/encode/module_picture.hpp"
#include "io/module_function.hpp"

#include <microtrace/error.hpp>

#include <dlfcn.h>
#include <utility>

namespace microtrace::io {
namespace {

/// The number of threads that log4cplus, a dependency of OpenImageIO, starts.
constexpr unsigned kThreadsOfLibraries = 4;

void* load_module(const FormatModule& format_module, const std::string& file) {
  require_threads(format_module, file);
  const Module module = open_module(format_module.file);
  if (module.handle != nullptr) return module.handle;
  std::string message = "can't be written without the module ";
  message.append(format_module.file);
  message += module.path.empty() ? ", searched in " + module.sought : ": " + module.complaint;
  message.append("; install ").append(format_module.package);
  message.append(" and build the target ").append(format_module.target);
  throw Error(
      ErrorKind::unsupported, file,
      message + ", set MICROTRACE_MODULE_PATH to the module's folder, or write .ppm or .png");
}

template <typename Function>
Function find_function(void* module, const char* name, const std::string& file) {
  if (void* address = ::dlsym(module, name)) return reinterpret_cast<Function>(address);
  throw Error(
      ErrorKind::unsupported, file,
      "its module belongs to another version of microtrace; install both from the same build");
}

/// The receivers of a module's output. Exceptions must not propagate through the module's frames,
/// so they are stored here.
struct Sinks {
  const std::function<void(std::string_view)>& out;
  std::string reason;
  std::exception_ptr thrown;
};

void take_bytes(void* context, const char* bytes, std::size_t size) {
  auto& sinks = *static_cast<Sinks*>(context);
  if (sinks.thrown) return;
  try {
    sinks.out(std::string_view(bytes, size));
  } catch (...) {
    sinks.thrown = std::current_exception();
  }
}

void take_reason(void* context, const char* bytes, std::size_t size) {
  static_cast<Sinks*>(context)->reason.append(bytes, size);
}

}  // namespace

void require_threads(const FormatModule& module, const std::string& file) {
  if (!module.starts_threads) return;
  const auto require = [&] {
    // OpenImageIO itself starts one more thread per processor.
    if (can_start_threads(kThreadsOfLibraries + allowed_processors())) return true;
    throw Error(ErrorKind::limit, file,
                "needs OpenImageIO, whose libraries start more threads than the limits on "
                "processes and memory allow; raise these, or use .ppm, .png or .exr");
  };
  // Checks only until it succeeds, because the libraries start their threads only once.
  static const bool is_granted = require();
  static_cast<void>(is_granted);
}

const FormatModule& module_for(std::string_view extension) {
  static constexpr FormatModule kOpenexr{
      .file = "microtrace_openexr.so", .package = "libopenexr-dev", .target = "microtrace_openexr"};
  static constexpr FormatModule kOpenimageio{.file = "microtrace_openimageio.so",
                                             .package = "libopenimageio-dev",
                                             .target = "microtrace_openimageio",
                                             .starts_threads = true};
  return extension == "exr" ? kOpenexr : kOpenimageio;
}

ImageModule::ImageModule(std::string file, std::string_view extension) : file_(std::move(file)) {
  void* module = load_module(module_for(extension), file_);
  find_format_ = find_function<MicrotraceFindFormat>(module, kFindFormatName, file_);
  encode_ = find_function<MicrotraceEncode>(module, kEncodeName, file_);
}

MicrotraceFormat ImageModule::find_format(const std::string& extension) const {
  MicrotraceFormat format{};
  if (find_format_(extension.c_str(), &format) != 0) return format;
  std::string message = "no picture can be written with the extension .";
  message += extension;
  message += "; use .ppm, .png or .exr, or another format of OpenImageIO";
  throw Error(ErrorKind::usage, file_, message);
}

void ImageModule::encode(const Film& film, const std::string& extension,
                         const std::function<void(std::string_view)>& out) const {
  const ModulePicture picture(film, find_format(extension));
  Sinks sinks{out, {}, {}};
  const int failed = encode_(&picture.get(), extension.c_str(), take_bytes, take_reason, &sinks);
  if (sinks.thrown) std::rethrow_exception(sinks.thrown);
  if (failed == 0) return;
  if (failed == 2) throw lack_of_memory(file_);
  std::string message = "can't be encoded: ";
  message += sinks.reason;
  message += "; use .ppm, .png or .exr";
  throw Error(ErrorKind::io, file_, message);
}

}  // namespace microtrace::io
