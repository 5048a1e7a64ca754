#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace pixelflex::devices {

/// A still camera as libgphoto2 offers it: settings by name, and photographs. Errors are thrown as std::runtime_error.
class StillDevice {
 public:
  StillDevice() = default;
  virtual ~StillDevice() = default;
  StillDevice(const StillDevice&) = delete;
  StillDevice& operator=(const StillDevice&) = delete;

  /// What a setting is; none where there is no such setting.
  [[nodiscard]] virtual std::optional<std::string> value(const std::string& setting) = 0;
  [[nodiscard]] virtual std::vector<std::string> choices(const std::string& setting) = 0;
  /// It may not have been taken: ask value() afterwards.
  virtual void set(const std::string& setting, const std::string& value) = 0;
  /// Takes a photograph and returns its file.
  [[nodiscard]] virtual std::vector<std::uint8_t> capture() = 0;
};

/// The cameras on USB: model and port.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> listStillDevices();

/// `name`: "first", a model, or a port such as "usb:001,004". Throws std::runtime_error saying why it cannot be had.
[[nodiscard]] std::unique_ptr<StillDevice> openStillDevice(const std::string& name);

}  // namespace pixelflex::devices
