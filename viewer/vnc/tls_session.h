#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "viewer/vnc/waiting.h"

namespace pixelflex::viewer {

/// The client's end of TLS on a connected socket: 1.2 without certificates, or 1.2 and later with. Whose certificate it
/// is must be checked after the handshake. libvncclient can read on with it, through handle(). One thread at a time.
class TlsSession {
 public:
  enum class Kind { kAnonymous, kX509 };

  /// `socket` stays the caller's and must outlive this; `hostName` (may be empty) tells a server with several
  /// certificates which one is meant. Throws std::runtime_error when GnuTLS fails.
  TlsSession(int socket, Kind kind, const std::string& hostName);
  ~TlsSession();
  TlsSession(const TlsSession&) = delete;
  TlsSession& operator=(const TlsSession&) = delete;

  /// False when `deadline` has passed. Throws std::runtime_error with GnuTLS's words, or SessionStopped.
  bool handshake(Deadline deadline, const Signal& stop);

  /// What read() and write() did: how many bytes, at least one; or that the socket is not ready; or the end.
  struct Transfer {
    std::size_t bytes = 0;
    bool again = false;
  };
  /// Neither blocks; a write that says "again" must be tried again with the same bytes. Both throw std::runtime_error
  /// with GnuTLS's words.
  Transfer read(std::span<std::uint8_t> bytes);
  Transfer write(std::span<const std::uint8_t> bytes);
  /// From here on, reads block as those of the socket do.
  void letReadsBlock();

  /// Decrypted bytes that poll() cannot see.
  [[nodiscard]] bool hasPendingBytes() const;
  /// DER, the server's own certificate first; empty when anonymous.
  [[nodiscard]] std::vector<std::vector<std::uint8_t>> certificates() const;
  /// GnuTLS's session, which stays this object's.
  [[nodiscard]] void* handle() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace pixelflex::viewer
