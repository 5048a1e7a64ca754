#include "tests/support/tls_server.h"

#include <gnutls/gnutls.h>

#include <stdexcept>

namespace pixelflex::testing {
namespace {

void check(int result) {
  if (result < 0) throw std::runtime_error(::gnutls_strerror(result));
}

}  // namespace

struct TlsServer::State {
  State() { check(::gnutls_init(&session, GNUTLS_SERVER | GNUTLS_NO_SIGNAL)); }
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    ::gnutls_deinit(session);
    if (anonymous != nullptr) ::gnutls_anon_free_server_credentials(anonymous);
    if (x509 != nullptr) ::gnutls_certificate_free_credentials(x509);
  }
  void beAnonymous() {
    check(::gnutls_anon_allocate_server_credentials(&anonymous));
    check(::gnutls_credentials_set(session, GNUTLS_CRD_ANON, anonymous));
    check(::gnutls_priority_set_direct(session, "NORMAL:-VERS-ALL:+VERS-TLS1.2:-KX-ALL:+ANON-ECDH", nullptr));
  }
  void show(const Certificates& certificates) {
    check(::gnutls_certificate_allocate_credentials(&x509));
    check(::gnutls_certificate_set_x509_key_file(x509, certificates.certificate().c_str(), certificates.key().c_str(),
                                                 GNUTLS_X509_FMT_PEM));
    check(::gnutls_credentials_set(session, GNUTLS_CRD_CERTIFICATE, x509));
    check(::gnutls_priority_set_direct(session, "NORMAL", nullptr));
  }

  gnutls_session_t session = nullptr;
  gnutls_anon_server_credentials_t anonymous = nullptr;
  gnutls_certificate_credentials_t x509 = nullptr;
};

TlsServer::TlsServer(const FakeConnection& connection, const Certificates* certificates)
    : state_(std::make_unique<State>()) {
  certificates != nullptr ? state_->show(*certificates) : state_->beAnonymous();
  ::gnutls_transport_set_int(state_->session, connection.socket());
  int result = 0;
  do {
    result = ::gnutls_handshake(state_->session);
  } while (result < 0 && ::gnutls_error_is_fatal(result) == 0);
  if (result < 0) throw FakeConnection::ClientGone{};
}

TlsServer::~TlsServer() = default;

void TlsServer::send(const Message& message) const {
  const auto sent = ::gnutls_record_send(state_->session, message.bytes().data(), message.bytes().size());
  if (sent != static_cast<ssize_t>(message.bytes().size())) throw FakeConnection::ClientGone{};
}

std::vector<std::uint8_t> TlsServer::receive(std::size_t count) const {
  std::vector<std::uint8_t> bytes(count);
  for (std::size_t got = 0; got < count;) {
    const auto part = ::gnutls_record_recv(state_->session, &bytes[got], count - got);
    if (part <= 0) throw FakeConnection::ClientGone{};
    got += static_cast<std::size_t>(part);
  }
  return bytes;
}

}  // namespace pixelflex::testing
