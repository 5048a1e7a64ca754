#include "viewer/vnc/known_servers.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cctype>
#include <cerrno>
#include <fstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {
namespace {

constexpr std::string_view kPrefix = "SHA256:";
constexpr std::size_t kDigits = 64;

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw std::runtime_error(file.string() + ": " + what);
}

std::string errorText() {
  return std::generic_category().message(errno);
}

bool isLineOf(const std::string& line, const std::string& server) {
  return line.starts_with(server + " ");
}

std::vector<std::string> readLines(const std::filesystem::path& file) {
  struct stat info {};
  if (::stat(file.c_str(), &info) != 0) {
    if (errno == ENOENT) return {};
    fail(file, "cannot be read: " + errorText());
  }
  if ((info.st_mode & (S_IWGRP | S_IWOTH)) != 0) {
    fail(file, "others can write this list of trusted servers; look it through and run chmod 600 " + file.string());
  }
  std::ifstream stream(file);
  if (!stream) fail(file, "cannot be read");
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

// The folder's lock: the file itself is replaced.
FileDescriptor lockFolder(const std::filesystem::path& folder) {
  std::error_code error;
  if (std::filesystem::create_directories(folder, error); error) fail(folder, error.message());
  FileDescriptor lock(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (lock.get() < 0 || ::flock(lock.get(), LOCK_EX) != 0) fail(folder, "cannot be locked: " + errorText());
  return lock;
}

void writeAll(const FileDescriptor& out, std::string_view text, const std::filesystem::path& file) {
  while (!text.empty()) {
    const ssize_t part = ::write(out.get(), text.data(), text.size());
    if (part < 0 && errno != EINTR) fail(file, "cannot be written: " + errorText());
    text.remove_prefix(part > 0 ? static_cast<std::size_t>(part) : 0);
  }
  if (::fsync(out.get()) != 0) fail(file, "cannot be written: " + errorText());
}

void replace(const std::filesystem::path& file, const std::string& text) {
  const std::filesystem::path fresh = file.string() + ".new";
  {
    const FileDescriptor out(::open(fresh.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC | O_NOFOLLOW, 0600));
    if (out.get() < 0) fail(fresh, "cannot be made: " + errorText());
    writeAll(out, text, fresh);
  }
  if (::rename(fresh.c_str(), file.c_str()) != 0) fail(file, "cannot be replaced: " + errorText());
}

}  // namespace

std::optional<std::string> KnownServers::find(const std::string& server) const {
  for (const std::string& line : readLines(file_)) {
    if (!isLineOf(line, server)) continue;
    std::optional<std::string> fingerprint = normalFingerprint(line.substr(server.size() + 1));
    if (!fingerprint) fail(file_, "the line of " + server + " holds no fingerprint (SHA256:…): correct or remove it");
    return fingerprint;
  }
  return std::nullopt;
}

void KnownServers::remember(const std::string& server, const std::string& fingerprint) const {
  const FileDescriptor lock = lockFolder(std::filesystem::absolute(file_).parent_path());
  std::string text;
  for (const std::string& line : readLines(file_)) {
    if (!isLineOf(line, server)) text += line + "\n";
  }
  replace(file_, text + server + " " + std::string(kPrefix) + fingerprint + "\n");
}

std::optional<std::string> normalFingerprint(const std::string& text) {
  std::string digits;
  for (const char c : text.starts_with(kPrefix) ? text.substr(kPrefix.size()) : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == ':') continue;
    if (std::isxdigit(byte) == 0) return std::nullopt;
    if (!digits.empty() && digits.size() % 3 == 2) digits += ':';
    digits += static_cast<char>(std::toupper(byte));
  }
  if (digits.size() != kDigits + kDigits / 2 - 1) return std::nullopt;
  return digits;
}

}  // namespace pixelflex::viewer
