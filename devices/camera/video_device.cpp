#include "devices/camera/video_device.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <vector>

namespace pixelflex::devices {
namespace {

class KernelVideoDevice final : public VideoDevice {
 public:
  explicit KernelVideoDevice(const std::string& path)
      : descriptor_(::open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), path);
  }
  ~KernelVideoDevice() override {
    for (const auto& [start, length] : maps_) ::munmap(start, length);
    ::close(descriptor_);
  }
  KernelVideoDevice(const KernelVideoDevice&) = delete;
  KernelVideoDevice& operator=(const KernelVideoDevice&) = delete;

  int request(unsigned long code, void* argument) override {
    int result = 0;
    do {
      result = ::ioctl(descriptor_, code, argument);
    } while (result < 0 && errno == EINTR);
    return result < 0 ? errno : 0;
  }
  [[nodiscard]] std::span<const std::uint8_t> map(std::size_t length, std::int64_t offset) override {
    void* start = ::mmap(nullptr, length, PROT_READ, MAP_SHARED, descriptor_, offset);
    if (start == MAP_FAILED) return {};
    maps_.push_back({start, length});
    return {static_cast<const std::uint8_t*>(start), length};
  }
  [[nodiscard]] bool wait(std::chrono::milliseconds patience) override {
    pollfd waited{descriptor_, POLLIN, 0};
    return ::poll(&waited, 1, static_cast<int>(patience.count())) > 0;
  }

 private:
  struct Map {
    void* start;
    std::size_t length;
  };
  int descriptor_;
  std::vector<Map> maps_;
};

}  // namespace

std::unique_ptr<VideoDevice> openVideoDevice(const std::string& path) {
  return std::make_unique<KernelVideoDevice>(path);
}

}  // namespace pixelflex::devices
