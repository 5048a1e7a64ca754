#include "viewer/vnc/certificate_check.h"

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>
#include <gnutls/x509.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>

#include "viewer/vnc/connector.h"
#include "viewer/vnc/known_servers.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kMostCertificates = 16;

[[noreturn]] void refuse(const std::string& message) {
  throw SessionError(CloseKind::kUntrusted, message);
}

struct FreeCertificate {
  void operator()(gnutls_x509_crt_t certificate) const { ::gnutls_x509_crt_deinit(certificate); }
};
using Certificate = std::unique_ptr<gnutls_x509_crt_int, FreeCertificate>;

struct FreeTrust {
  void operator()(gnutls_x509_trust_list_t list) const { ::gnutls_x509_trust_list_deinit(list, 1); }
};
using Trust = std::unique_ptr<gnutls_x509_trust_list_st, FreeTrust>;

std::vector<Certificate> parseChain(const CertificateChain& chain, const std::string& where) {
  std::vector<Certificate> parsed;
  for (const std::vector<std::uint8_t>& der : chain) {
    gnutls_x509_crt_t made = nullptr;
    if (::gnutls_x509_crt_init(&made) < 0) throw std::bad_alloc();
    parsed.emplace_back(made);
    std::vector<std::uint8_t> bytes = der;  // GnuTLS takes no constant ones
    const gnutls_datum_t datum{bytes.data(), static_cast<unsigned>(bytes.size())};
    if (::gnutls_x509_crt_import(made, &datum, GNUTLS_X509_FMT_DER) < 0) {
      refuse(where + " shows a certificate that cannot be read");
    }
  }
  return parsed;
}

Trust loadTrust(const std::string& caFile) {
  gnutls_x509_trust_list_t made = nullptr;
  if (::gnutls_x509_trust_list_init(&made, 0) < 0) throw std::bad_alloc();
  Trust trust(made);
  if (caFile.empty()) {
    ::gnutls_x509_trust_list_add_system_trust(made, 0, 0);  // a system without any trusts nobody
  } else if (::gnutls_x509_trust_list_add_trust_file(made, caFile.c_str(), nullptr, GNUTLS_X509_FMT_PEM, 0, 0) <= 0) {
    refuse(caFile + ": holds no certificate (PEM) that could be read: give the file of the authority with --tls-ca");
  }
  return trust;
}

std::string describeStatus(unsigned status) {
  gnutls_datum_t text{};
  if (::gnutls_certificate_verification_status_print(status, GNUTLS_CRT_X509, &text, 0) < 0) return "not valid";
  std::string words(reinterpret_cast<const char*>(text.data), text.size);
  ::gnutls_free(text.data);
  while (!words.empty() && (words.back() == ' ' || words.back() == '\0')) words.pop_back();
  return words;
}

// Why the authorities do not vouch for the server; empty when they do.
std::string complaintOf(const Trust& trust, std::vector<Certificate>& chain, const ServerAddress& server) {
  std::vector<gnutls_x509_crt_t> list;
  for (const Certificate& certificate : chain) list.push_back(certificate.get());
  gnutls_typed_vdata_st purpose{};
  purpose.type = GNUTLS_DT_KEY_PURPOSE_OID;
  std::string serverPurpose = GNUTLS_KP_TLS_WWW_SERVER;
  purpose.data = reinterpret_cast<unsigned char*>(serverPurpose.data());
  unsigned status = 0;
  if (::gnutls_x509_trust_list_verify_crt2(trust.get(), list.data(), static_cast<unsigned>(list.size()), &purpose, 1, 0,
                                           &status, nullptr) < 0) {
    return "it cannot be verified";
  }
  if (status != 0) return describeStatus(status);
  if (!server.isUnixSocket() && ::gnutls_x509_crt_check_hostname(list.front(), server.host.c_str()) == 0) {
    return "it is not for the name " + server.host;
  }
  return {};
}

void requireFingerprint(const std::string& shown, const ServerAddress& server, const SecurityOptions& options) {
  if (normalFingerprint(options.fingerprint) != shown) {
    refuse(describeServer(server) +
           " shows a certificate with another fingerprint than the one asked for: SHA256:" + shown);
  }
  if (options.knownServersFile.empty()) return;
  const KnownServers known(options.knownServersFile);
  if (known.find(server.text()) != shown) known.remember(server.text(), shown);
}

void requireAuthority(const std::string& complaint, const std::string& where, const SecurityOptions& options) {
  if (complaint.empty()) return;
  refuse("the certificate of " + where + " is not trusted by " + options.caFile + ": " + complaint);
}

void requireRemembered(const std::string& shown, const std::string& remembered, const ServerAddress& server,
                       const SecurityOptions& options) {
  if (shown == remembered) return;
  refuse("THE CERTIFICATE OF " + server.text() +
         " HAS CHANGED. Somebody may be pretending to be this server. It was SHA256:" + remembered +
         " and is now SHA256:" + shown +
         ". Nothing was sent. If whoever runs the server confirms the new one, remove the line of " + server.text() +
         " from " + options.knownServersFile + " and connect again");
}

// The first meeting with this server.
std::string trustNow(const std::string& shown, const std::string& complaint, const ServerAddress& server,
                     const SecurityOptions& options) {
  const std::string where = describeServer(server);
  const std::string how = "compare its fingerprint, SHA256:" + shown +
                          ", with the server's own and give it with --tls-fingerprint, or its authority with --tls-ca";
  if (options.require == SecurityLevel::kX509 || options.knownServersFile.empty()) {
    refuse("the certificate of " + where + " is not known: " + complaint + ": " + how);
  }
  KnownServers(options.knownServersFile).remember(server.text(), shown);
  return shown;
}

std::optional<std::string> rememberedFor(const ServerAddress& server, const SecurityOptions& options) {
  if (options.knownServersFile.empty()) return std::nullopt;
  return KnownServers(options.knownServersFile).find(server.text());
}

std::string decide(const CertificateChain& chain, const ServerAddress& server, const SecurityOptions& options) {
  const std::string where = describeServer(server);
  if (chain.empty()) refuse(where + " shows no certificate");
  if (chain.size() > kMostCertificates) refuse(where + " shows too many certificates");
  const std::string shown = fingerprintOf(chain.front());
  std::vector<Certificate> parsed = parseChain(chain, where);
  if (!options.fingerprint.empty()) {
    requireFingerprint(shown, server, options);
    return {};
  }
  if (!options.caFile.empty()) {
    requireAuthority(complaintOf(loadTrust(options.caFile), parsed, server), where, options);
    return {};
  }
  if (const auto remembered = rememberedFor(server, options)) {
    requireRemembered(shown, *remembered, server, options);
    return {};
  }
  const std::string complaint = complaintOf(loadTrust({}), parsed, server);
  return complaint.empty() ? std::string{} : trustNow(shown, complaint, server, options);
}

}  // namespace

std::string fingerprintOf(const std::vector<std::uint8_t>& certificate) {
  std::array<std::uint8_t, 32> hash{};
  if (::gnutls_hash_fast(GNUTLS_DIG_SHA256, certificate.data(), certificate.size(), hash.data()) < 0) {
    throw std::runtime_error("GnuTLS cannot make a SHA-256");
  }
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string text;
  for (const std::uint8_t byte : hash) {
    if (!text.empty()) text += ':';
    text += {kHex[byte >> 4], kHex[byte & 15]};
  }
  return text;
}

std::string checkCertificate(const CertificateChain& chain, const ServerAddress& server,
                             const SecurityOptions& options) try {
  return decide(chain, server, options);
} catch (const SessionError&) {
  throw;
} catch (const std::runtime_error& error) {
  refuse(error.what());
}

void refuseForgottenCertificate(const ServerAddress& server, const SecurityOptions& options) {
  std::optional<std::string> remembered;
  try {
    remembered = rememberedFor(server, options);
  } catch (const std::runtime_error& error) {
    refuse(error.what());
  }
  if (!remembered) return;
  refuse(server.text() +
         " HAS SHOWN A CERTIFICATE BEFORE AND NOW OFFERS NONE. Somebody may be pretending to be this server. Nothing "
         "was sent. If it was set up anew without certificates, remove its line from " +
         options.knownServersFile + " and connect again");
}

}  // namespace pixelflex::viewer
