#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "viewer/vnc/security.h"
#include "viewer/vnc/server_address.h"

namespace pixelflex::viewer {

/// Certificates as a server shows them: DER, its own first.
using CertificateChain = std::vector<std::vector<std::uint8_t>>;

/// SHA-256 of a DER certificate, "AB:CD:…".
[[nodiscard]] std::string fingerprintOf(const std::vector<std::uint8_t>& certificate);

/// Decides whether `server` may show `chain`: by the fingerprint that the options ask for (then remembered), else by
/// their authorities, else by the certificate remembered for the server, else by the system's authorities, else it is
/// trusted because it is the first one seen there, and remembered. Returns its fingerprint in this last case, otherwise
/// "". Throws SessionError (kUntrusted).
[[nodiscard]] std::string checkCertificate(const CertificateChain& chain, const ServerAddress& server,
                                           const SecurityOptions& options);

/// Throws SessionError (kUntrusted) when a certificate is remembered for `server`, which now offers a connection
/// without one: perhaps somebody in between wants it so.
void refuseForgottenCertificate(const ServerAddress& server, const SecurityOptions& options);

}  // namespace pixelflex::viewer
