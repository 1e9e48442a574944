#include <microtrace/threads.hpp>

#include <algorithm>
#include <sched.h>
#include <thread>

namespace microtrace {

unsigned default_threads() {
  // hardware_concurrency() also counts processors that a container or taskset excludes.
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0)
    return static_cast<unsigned>(std::max(1, CPU_COUNT(&allowed)));
  return std::max(1U, std::thread::hardware_concurrency());
}

}  // namespace microtrace
