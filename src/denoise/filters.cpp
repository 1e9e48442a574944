#include "denoise/filters.hpp"

#include "base/system/processors.hpp"
#include "base/system/start_threads.hpp"

#include <microtrace/error.hpp>

#include <string>

namespace microtrace {

bool ProgressMonitor::goes_on(void* context, double /*share*/) {
  auto& self = *static_cast<ProgressMonitor*>(context);
  try {
    if (self.is_canceled || self.progress(1)) return !self.is_canceled;
  } catch (...) {
    self.thrown = std::current_exception();
  }
  self.is_canceled = true;
  return false;
}

Filters::Filters(const OidnFunctions& functions, ImageSize size, const RenderOptions& options)
    : f_(functions), size_(size), monitor_{.progress = options.progress} {
  // The library ends the process if the system refuses a thread.
  const unsigned wanted = thread_count(options.threads);
  device_ = oidn::open_device(f_, can_start_threads(wanted) ? wanted : 1);
}

void Filters::run(std::initializer_list<NamedImage> images) {
  const oidn::Filter filter(f_.new_filter(device_.get(), "RT"), {&f_});
  const auto set = [&](const char* name, std::vector<Vec3>& pixels) {
    f_.set_shared_filter_image(filter.get(), name, pixels.data(), oidn::kFloat3, size_.width,
                               size_.height, 0, 0, 0);
  };
  for (const auto& [name, pixels] : images) set(name, pixels);
  set("output", images.begin()->pixels);
  if (images.size() > 1) {
    f_.set_filter_bool(filter.get(), "hdr", true);
    f_.set_filter_bool(filter.get(), "cleanAux", true);
  }
  f_.set_filter_int(filter.get(), "maxMemoryMB", static_cast<int>(kMostMegabytes));
  if (monitor_.progress) {
    f_.set_filter_progress_monitor_function(filter.get(), ProgressMonitor::goes_on, &monitor_);
  }
  f_.commit_filter(filter.get());
  f_.execute_filter(filter.get());
  check();
}

void Filters::check() {
  if (monitor_.thrown) std::rethrow_exception(monitor_.thrown);
  const char* message = nullptr;
  const int error = f_.get_device_error(device_.get(), &message);
  if (error == 0) return;
  const ErrorKind kind = error == oidn::kCanceled      ? ErrorKind::canceled
                         : error == oidn::kOutOfMemory ? ErrorKind::limit
                                                       : ErrorKind::internal;
  throw Error(kind, "", std::string("denoising failed: ") + message);
}

}  // namespace microtrace
