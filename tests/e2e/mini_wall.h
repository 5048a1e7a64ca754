#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <stdexcept>

#include "tests/e2e/programs.h"

namespace pixelflex::testing {

/// Makes `wall` the two-projector rig, calibrated live. Photographing it takes seconds, so that it is done once for
/// each build of the program, by whichever test comes first, and copied by all.
inline void makeMiniWall(const std::filesystem::path& wall) {
  namespace fs = std::filesystem;
  const auto built = fs::last_write_time(std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-calibrate");
  const fs::path walls = fs::path(PIXELFLEX_BIN_DIR).parent_path() / "test-walls";
  const fs::path made = walls / ("mini-" + std::to_string(built.time_since_epoch().count()));
  fs::create_directories(walls);
  const int lock = ::open((walls / "lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (lock < 0 || ::flock(lock, LOCK_EX) != 0) throw std::runtime_error("no lock in " + walls.string());
  if (!fs::exists(made)) {
    for (const auto& entry : fs::directory_iterator(walls))
      if (entry.is_directory()) fs::remove_all(entry.path());
    const std::string draft = (walls / "draft").string();
    Output run = runProgram("new", {draft, "--rig", kMiniRig});
    if (run.status == 0) run = runProgram("calibrate", {draft});
    if (run.status != 0) throw std::runtime_error(run.text);
    fs::rename(draft, made);
  }
  fs::copy(made, wall, fs::copy_options::recursive);
  ::close(lock);
}

}  // namespace pixelflex::testing
