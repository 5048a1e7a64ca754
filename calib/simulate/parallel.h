#pragma once

#include <thread>

namespace pixelflex::calib {

/// Calls work(first, last) for the two halves of [0, rows), one on a second thread. The halves must not touch each
/// other's data, and `work` must not throw.
template <class Work>
void inTwoHalves(int rows, const Work& work) {
  if (rows < 64) {
    work(0, rows);
    return;
  }
  std::jthread second([&work, rows] { work(rows / 2, rows); });
  work(0, rows / 2);
}

}  // namespace pixelflex::calib
