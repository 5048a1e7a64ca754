#include "tests/bench/viewer_run.h"

#include <fstream>
#include <iterator>
#include <stdexcept>

namespace pixelflex::testing {
namespace {

std::string textOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string program(const std::string& name) {
  return std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-" + name;
}

}  // namespace

ViewerRun::ViewerRun(devices::Size screen, const std::string& server, std::vector<std::string> more) {
  const std::string wall = (folder_ / "wall").string();
  const std::string size = std::to_string(screen.width) + "x" + std::to_string(screen.height);
  const Output made = run({program("new"), wall, "--flat", size});
  if (made.status != 0) throw std::runtime_error(made.text);
  std::vector<std::string> command{program("view"), wall, server, "--headless"};
  command.insert(command.end(), more.begin(), more.end());
  process_ = std::make_unique<Process>(
      command, ProcessOptions{.environment = {"LIBGL_ALWAYS_SOFTWARE=1"}, .log = folder_ / "log"});
}

std::string ViewerRun::log() const {
  return textOf(folder_ / "log");
}

Held ViewerRun::held() const {
  const std::filesystem::path folder = "/proc/" + std::to_string(process_->pid());
  const std::string status = textOf(folder / "status");
  const auto at = status.find("VmRSS:");
  if (at == std::string::npos) throw std::runtime_error("the viewer has ended: " + log());
  namespace fs = std::filesystem;
  return {std::distance(fs::directory_iterator(folder / "fd"), fs::directory_iterator()),
          std::stod(status.substr(at + 6)) / 1024};
}

}  // namespace pixelflex::testing
