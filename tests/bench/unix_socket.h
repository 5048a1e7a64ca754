#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace pixelflex::testing {

/// A UNIX stream socket. Whatever fails throws std::runtime_error; nothing waits longer than half a minute.
class UnixSocket {
 public:
  explicit UnixSocket(int descriptor) : descriptor_(descriptor) {}
  ~UnixSocket();
  UnixSocket(UnixSocket&& other) noexcept;
  UnixSocket(const UnixSocket&) = delete;
  UnixSocket& operator=(const UnixSocket&) = delete;

  [[nodiscard]] static UnixSocket connected(const std::string& path);
  [[nodiscard]] static UnixSocket listening(const std::string& path);
  /// Of a listening one: its next client.
  [[nodiscard]] UnixSocket accept() const;

  void write(std::span<const std::uint8_t> bytes) const;
  [[nodiscard]] std::vector<std::uint8_t> read(std::size_t count) const;
  /// What has come, once something has; empty after `time` in vain.
  [[nodiscard]] std::vector<std::uint8_t> readSome(std::chrono::milliseconds time) const;
  /// As much as is taken without waiting.
  [[nodiscard]] std::size_t writeSome(std::span<const std::uint8_t> bytes) const;
  /// Until it can be read, or written to if that is wanted.
  void wait(bool toWrite) const;

 private:
  int descriptor_;
};

}  // namespace pixelflex::testing
