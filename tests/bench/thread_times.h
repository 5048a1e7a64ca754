#pragma once

#include <sys/types.h>

namespace pixelflex::testing {

/// Processor seconds of a process's threads that run now.
struct ThreadTimes {
  double main = 0;    // the program's first thread, which draws; what the GL driver does on it is among them
  double others = 0;  // the source's, above all
  double driver = 0;  // the software GL's own threads, by their names

  [[nodiscard]] double own() const { return main + others; }
  [[nodiscard]] double all() const { return main + others + driver; }
  [[nodiscard]] ThreadTimes operator-(const ThreadTimes& before) const {
    return {main - before.main, others - before.others, driver - before.driver};
  }
};

[[nodiscard]] ThreadTimes threadTimes(pid_t process);

}  // namespace pixelflex::testing
