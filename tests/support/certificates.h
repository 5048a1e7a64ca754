#pragma once

#include <string>

#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {

/// An authority and the certificate of a server, made with openssl in a folder of their own.
class Certificates {
 public:
  /// `names` is what the certificate is for, like "DNS:localhost,IP:127.0.0.1".
  explicit Certificates(const std::string& names = "DNS:localhost,IP:127.0.0.1");

  /// PEM files.
  [[nodiscard]] std::string authority() const { return (folder_ / "ca.pem").string(); }
  [[nodiscard]] std::string certificate() const { return (folder_ / "server.pem").string(); }
  [[nodiscard]] std::string key() const { return (folder_ / "server.key").string(); }
  /// Of the server's certificate, as openssl prints it: "AB:CD:…".
  [[nodiscard]] std::string fingerprint() const;

 private:
  TemporaryFolder folder_;
};

}  // namespace pixelflex::testing
