#include "tests/bench/watched_screen.h"

#include <X11/XWDFile.h>
#include <arpa/inet.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>

namespace pixelflex::testing {
namespace {

constexpr std::size_t kColourBytes = 12;  // of an entry of the colour table, which precedes the pixels

}  // namespace

WatchedScreen::WatchedScreen(devices::Size size)
    : size_(size), x_([size](const TemporaryFolder& folder) {
        const std::string screen = std::to_string(size.width) + "x" + std::to_string(size.height) + "x24";
        return std::vector<std::string>{"Xvfb",     "-screen",   "0",   screen,     "-fbdir", folder.path().string(),
                                        "-noreset", "-nolisten", "tcp", "-nocursor"};
      }) {
  const std::filesystem::path file = x_.folder() / "Xvfb_screen0";
  bytes_ = std::filesystem::file_size(file);
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  memory_ = ::mmap(nullptr, bytes_, PROT_READ, MAP_SHARED, descriptor, 0);
  ::close(descriptor);
  if (memory_ == MAP_FAILED) throw std::runtime_error("cannot map " + file.string());
  XWDFileHeader header{};
  std::memcpy(&header, memory_, sizeof header);
  pixels_ = ntohl(header.header_size) + kColourBytes * ntohl(header.ncolors);
  row_ = ntohl(header.bytes_per_line);
  if (ntohl(header.bits_per_pixel) != 32) throw std::runtime_error("the screen has not 32 bits for a pixel");
}

WatchedScreen::~WatchedScreen() {
  ::munmap(memory_, bytes_);
}

std::uint32_t WatchedScreen::pixel(glm::ivec2 at) const {
  const auto* const bytes = static_cast<const volatile std::uint8_t*>(memory_) + pixels_ +
                            row_ * static_cast<std::size_t>(at.y) + std::size_t{4} * static_cast<std::size_t>(at.x);
  return *reinterpret_cast<const volatile std::uint32_t*>(bytes) & 0xffffffU;
}

std::optional<glm::ivec2> WatchedScreen::find(std::uint32_t colour) const {
  for (int y = 0; y < size_.height; ++y) {
    for (int x = 0; x < size_.width; ++x) {
      if (pixel({x, y}) == colour) return glm::ivec2(x, y);
    }
  }
  return std::nullopt;
}

}  // namespace pixelflex::testing
