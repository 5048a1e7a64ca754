#include "viewer/tiles/thread_time.h"

#include <ctime>

namespace pixelflex::viewer {

std::chrono::nanoseconds threadTime() {
  timespec time{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

}  // namespace pixelflex::viewer
