#pragma once

#include <functional>
#include <memory>
#include <string>

#include "devices/image/image.h"

namespace pixelflex::devices {

/// A GigE Vision camera at an address of this machine (UDP port 3956), for any program that speaks that protocol: found
/// by searching, controlled by one client at a time, triggered by software or running by itself, frames sent again in
/// parts where packets were lost. Its pictures come from a function.
class GigeCamera {
 public:
  struct Options {
    std::string serial = "01";          // up to 15 characters
    Size size;                          // of the whole picture
    std::string address = "127.0.0.1";  // of this machine; one camera each
  };
  /// A picture of `size`, three channels, that starts to be exposed now, for so many seconds. Called on a thread of the
  /// camera's; what it throws is given to `complain` (on that thread), and the frame is left out.
  using Photograph = std::function<Image8(double seconds)>;
  using Complain = std::function<void(const std::string& what)>;

  /// Throws std::runtime_error when the address is taken or not of this machine.
  GigeCamera(const Options& options, Photograph photograph, Complain complain);
  ~GigeCamera();
  GigeCamera(const GigeCamera&) = delete;
  GigeCamera& operator=(const GigeCamera&) = delete;

  /// What programs that use Aravis call it.
  [[nodiscard]] const std::string& name() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace pixelflex::devices
