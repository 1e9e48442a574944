// This preloaded library limits the number of threads. Creating a thread fails if there are already
// MOST_THREADS threads, besides the first, that were started and not joined. Threads that have
// ended but were not joined count too.

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <dlfcn.h>
#include <pthread.h>

namespace {

std::atomic<int> unjoined{0};

}  // namespace

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*function)(void*), void* argument) {
  const char* const most = std::getenv("MOST_THREADS");
  if (++unjoined > (most != nullptr ? std::atoi(most) : 0)) {
    --unjoined;
    return EAGAIN;
  }
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  return create(thread, attributes, function, argument);
}

extern "C" int pthread_join(pthread_t thread, void** result) {
  using Join = int (*)(pthread_t, void**);
  static const auto join = reinterpret_cast<Join>(dlsym(RTLD_NEXT, "pthread_join"));
  const int status = join(thread, result);
  if (status == 0) --unjoined;
  return status;
}
