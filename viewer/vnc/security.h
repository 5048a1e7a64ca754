#pragma once

#include <string>
#include <string_view>

namespace pixelflex::viewer {

/// How far a connection is protected; each level is more than the one before.
enum class SecurityLevel {
  kNone,  // nobody is asked for anything
  kVnc,   // VNC's own password scheme, eight characters; nothing is encrypted
  kTls,   // encrypted, but the server may be anybody
  kX509,  // encrypted, and the server has shown a certificate that is trusted
};

/// As users write it: none, vnc, tls, x509. Throws std::invalid_argument for anything else.
[[nodiscard]] SecurityLevel parseSecurityLevel(std::string_view text);
[[nodiscard]] const char* nameOf(SecurityLevel level);

/// What a connection must be like. A server that offers less is refused; nothing falls back silently.
struct SecurityOptions {
  SecurityLevel require = SecurityLevel::kNone;
  /// PEM file with the only authorities to trust. Empty: those of the system, known servers, and trust on first use.
  std::string caFile;
  /// SHA-256 of the certificate in hexadecimal digits, perhaps with colons: the only one to trust. Empty: any of the
  /// other ways.
  std::string fingerprint;
  /// Where the certificates of servers seen before are remembered, see KnownServers. Empty: nowhere, and a certificate
  /// that no authority vouches for is refused.
  std::string knownServersFile;
};

/// How a connection turned out.
struct ConnectionSecurity {
  SecurityLevel level = SecurityLevel::kNone;
  /// Of a certificate that was trusted because this server was never seen before, as "AB:CD:…"; else empty.
  std::string newFingerprint;
  bool operator==(const ConnectionSecurity&) const = default;
};

}  // namespace pixelflex::viewer
