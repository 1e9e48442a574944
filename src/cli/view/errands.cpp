#include "cli/view/errands.hpp"

#include "base/system/float_environment.hpp"
#include "base/system/start_threads.hpp"

#include <utility>

namespace microtrace::cli {

bool Errands::run(std::function<void()> work) {
  forget_done();
  if (errands_.size() >= kMost) return false;
  const auto is_done = std::make_shared<std::atomic<bool>>(false);
  std::vector<Thread> thread = start_threads(1, [is_done, work = std::move(work)] {
    const FloatEnvironment environment;
    work();
    *is_done = true;
  });
  if (thread.empty()) return false;
  errands_.push_back({.is_done = is_done, .thread = std::move(thread)});
  return true;
}

bool Errands::are_done() {
  forget_done();
  return errands_.empty();
}

void Errands::forget_done() {
  errands_.remove_if([](const Errand& errand) { return errand.is_done->load(); });
}

}  // namespace microtrace::cli
