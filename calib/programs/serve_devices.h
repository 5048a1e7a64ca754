#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace pixelflex::calib {

struct ServeRequest {
  std::filesystem::path wall;
  std::vector<std::string> faults;  // "p1.mirror=stuck"
  double faster = 1;                // mirrors turn so much faster than real ones
};

/// Opens a line to a simulated device for every control and mirror of the wall, where wall.yaml says that it is, and
/// the camera of its room where that is `aravis:` (ServedRoom); tells each by `say`, which any thread may call; returns
/// when the process is asked to end (SIGINT, SIGTERM). Call it before any thread is started. Throws std::runtime_error.
void serveDevices(const ServeRequest& request, const std::function<void(const std::string& line)>& say);

}  // namespace pixelflex::calib
