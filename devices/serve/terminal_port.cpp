#include <fcntl.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/write.hpp>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "devices/serve/host_port.h"

namespace pixelflex::devices {
namespace {

namespace asio = boost::asio;
namespace fs = std::filesystem;

/// Handlers hold it while they are pending.
struct Terminal {
  explicit Terminal(asio::io_context& context) : master(context) {}
  ~Terminal() { ::close(slave); }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;
  asio::posix::stream_descriptor master;
  int slave = -1;  // kept open, so that clients may come and go
  std::array<char, 512> incoming{};
};

class TerminalPort : public HostPort {
 public:
  TerminalPort(asio::io_context& context, std::unique_ptr<SimulatedDevice> device, std::string path)
      : HostPort(context, std::move(device)), context_(context), path_(std::move(path)) {}
  ~TerminalPort() override {
    *alive_ = false;
    close();
  }
  TerminalPort(const TerminalPort&) = delete;
  TerminalPort& operator=(const TerminalPort&) = delete;

  [[nodiscard]] std::string address() const override { return "serial:" + path_; }

  void openLine() override {
    const int master = ::posix_openpt(O_RDWR | O_NOCTTY | O_CLOEXEC | O_NONBLOCK);
    std::array<char, 128> name{};
    if (master < 0 || ::grantpt(master) != 0 || ::unlockpt(master) != 0 ||
        ::ptsname_r(master, name.data(), name.size()) != 0) {
      throw std::runtime_error("there is no terminal to be had: " + std::string(std::strerror(errno)));
    }
    terminal_ = std::make_shared<Terminal>(context_);
    terminal_->master.assign(master);
    terminal_->slave = ::open(name.data(), O_RDWR | O_NOCTTY | O_CLOEXEC);
    termios mode{};
    ::tcgetattr(terminal_->slave, &mode);
    ::cfmakeraw(&mode);
    ::tcsetattr(terminal_->slave, TCSANOW, &mode);
    link(name.data());
    read(terminal_);
  }

  void closeLine() override { close(); }

 protected:
  void give(const std::string& bytes) override {
    if (!terminal_) return;
    // What nobody reads is lost when the terminal is full, as on a wire.
    boost::system::error_code ignored;
    terminal_->master.write_some(asio::buffer(bytes), ignored);
  }

 private:
  void link(const fs::path& terminal) {
    std::error_code error;
    if (fs::is_symlink(path_) && fs::read_symlink(path_).string().starts_with("/dev/pts/")) fs::remove(path_, error);
    if (const fs::path folder = fs::path(path_).parent_path(); !folder.empty()) fs::create_directories(folder, error);
    error.clear();
    fs::create_symlink(terminal, path_, error);
    if (error) {
      close();
      throw std::runtime_error(path_ + ": no link can be made there: " + error.message());
    }
    linked_ = true;
  }

  void close() {
    std::error_code ignored;
    if (std::exchange(linked_, false)) fs::remove(path_, ignored);
    boost::system::error_code error;
    if (terminal_) terminal_->master.close(error);
    terminal_.reset();
  }

  void read(const std::shared_ptr<Terminal>& terminal) {
    terminal->master.async_read_some(
        asio::buffer(terminal->incoming),
        [this, alive = alive_, terminal](const boost::system::error_code& error, std::size_t count) {
          if (error || !*alive || terminal != terminal_) return;
          take(std::string_view(terminal->incoming.data(), count));
          if (terminal == terminal_) read(terminal);
        });
  }

  asio::io_context& context_;
  std::string path_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);  // handlers may come after this has gone
  std::shared_ptr<Terminal> terminal_;
  bool linked_ = false;
};

}  // namespace

std::unique_ptr<HostPort> makeTerminalPort(asio::io_context& context, std::unique_ptr<SimulatedDevice> device,
                                           std::string path) {
  return std::make_unique<TerminalPort>(context, std::move(device), std::move(path));
}

}  // namespace pixelflex::devices
