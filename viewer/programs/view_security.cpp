#include "viewer/programs/view_security.h"

#include <cstdlib>
#include <filesystem>

#include "viewer/programs/password.h"

namespace pixelflex::viewer {
namespace {

std::string environment(const char* name) {
  const char* value = std::getenv(name);
  return value == nullptr ? std::string{} : std::string(value);
}

std::string knownServersFile() {
  std::filesystem::path config = environment("XDG_CONFIG_HOME");
  const std::string home = environment("HOME");
  if (!config.is_absolute() && !home.empty()) config = std::filesystem::path(home) / ".config";
  return config.is_absolute() ? (config / "pixelflex" / "known_servers").string() : std::string{};
}

bool staysOnThisMachine(const ServerAddress& server) {
  return server.isXDisplay() || server.isUnixSocket() || server.host == "localhost" || server.host == "::1" ||
         server.host.starts_with("127.");
}

}  // namespace

void completeSecurity(ViewOptions& options) {
  std::optional<Secret> password = takePasswordOfEnvironment();
  if (options.passwordFile) password = readPasswordFile(*options.passwordFile);
  options.password = std::move(password);
  if (options.user.empty()) options.user = environment("PIXELFLEX_VNC_USER");
  options.security.knownServersFile = knownServersFile();
}

std::string securityNotice(const ViewOptions& options, const ConnectionSecurity& security) {
  const std::string server = options.server.text();
  if (!security.newFingerprint.empty()) {
    return server + " is new here. Its certificate, SHA256:" + security.newFingerprint + ", is trusted from now on (" +
           options.security.knownServersFile + "), and no other. Compare it with the server's own.";
  }
  if (staysOnThisMachine(options.server)) return {};
  if (security.level < SecurityLevel::kTls) {
    return "warning: the connection to " + server +
           " is not encrypted: whoever is on the way sees the desktop and every key (--require tls refuses this)";
  }
  if (security.level < SecurityLevel::kX509) {
    return "warning: the connection to " + server +
           " is encrypted, but the server may be anybody (--require x509 asks for a certificate)";
  }
  return {};
}

}  // namespace pixelflex::viewer
