#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace pixelflex::viewer {

/// A text file of certificates that were trusted on first use, one a line: "HOST:DISPLAY SHA256:AB:CD:…". Lines that
/// begin with # are comments. Changes replace the file in one step, mode 0600; several programs may do so at once.
/// Errors throw std::runtime_error that names the file.
class KnownServers {
 public:
  explicit KnownServers(std::filesystem::path file) : file_(std::move(file)) {}

  /// The fingerprint remembered for `server` (ServerAddress::text()). Throws as well when others may write the file.
  [[nodiscard]] std::optional<std::string> find(const std::string& server) const;
  /// Remembers `fingerprint`, in place of another one; makes the folder if need be.
  void remember(const std::string& server, const std::string& fingerprint) const;

 private:
  std::filesystem::path file_;
};

/// The digits in capitals with colons between the bytes: "AB:CD:…". Takes them with colons or without, in either case,
/// and perhaps with "SHA256:" before; nothing when they are not the 64 of a SHA-256.
[[nodiscard]] std::optional<std::string> normalFingerprint(const std::string& text);

}  // namespace pixelflex::viewer
