#include "tests/bench/thread_times.h"

#include <filesystem>
#include <fstream>
#include <string>

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;

std::string firstLine(const fs::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  return line;
}

}  // namespace

ThreadTimes threadTimes(pid_t process) {
  constexpr double kNanoseconds = 1e-9;
  ThreadTimes times;
  for (const auto& thread : fs::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
    const std::string used = firstLine(thread.path() / "schedstat");
    if (used.empty()) continue;  // it has ended meanwhile
    const double seconds = kNanoseconds * std::stod(used);
    if (firstLine(thread.path() / "comm").starts_with("llvmpipe-")) {
      times.driver += seconds;
    } else if (thread.path().filename() == std::to_string(process)) {
      times.main += seconds;
    } else {
      times.others += seconds;
    }
  }
  return times;
}

}  // namespace pixelflex::testing
