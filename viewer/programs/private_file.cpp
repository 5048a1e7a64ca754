#include "viewer/programs/private_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMaxFileBytes = 4096;

[[noreturn]] void fail(const std::string& file, const std::string& why) {
  throw std::runtime_error(file + ": " + why);
}

// Checks the file that was opened, not another one of its name.
void requirePrivate(const FileDescriptor& open, const std::string& file, const std::string& what) {
  struct stat info {};
  if (::fstat(open.get(), &info) != 0 || !S_ISREG(info.st_mode)) fail(file, "is not a " + what + " file");
  if ((info.st_mode & (S_IRWXG | S_IRWXO)) != 0) {
    fail(file, "others can read this " + what + " file; run chmod 600 " + file);
  }
}

}  // namespace

Secret readPrivateFile(const std::string& file, const std::string& what) {
  const auto cause = [&] { return "cannot read the " + what + ": " + std::generic_category().message(errno); };
  const FileDescriptor in(::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (in.get() < 0) fail(file, errno == ENOENT ? "no such " + what + " file" : cause());
  requirePrivate(in, file, what);
  std::array<char, kMaxFileBytes> bytes{};
  const ssize_t got = ::read(in.get(), bytes.data(), bytes.size());
  if (got < 0) fail(file, cause());
  Secret text(std::string_view(bytes.data(), static_cast<std::size_t>(got)));
  wipe(bytes);
  return text;
}

Secret readPrivateLine(const std::string& file, const std::string& what) {
  const Secret text = readPrivateFile(file, what);
  std::string_view line = text.text().substr(0, text.text().find('\n'));
  while (line.ends_with('\r')) line.remove_suffix(1);
  if (line.empty()) fail(file, "holds no " + what + " (its first line is taken)");
  return line;
}

}  // namespace pixelflex::viewer
