#include "devices/projector_control/pjlink_login.h"

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <array>
#include <charconv>
#include <span>
#include <vector>

#include "devices/control/device_error.h"

namespace pixelflex::devices {
namespace {

constexpr std::size_t kRandomBytes = 16;

std::string hexOf(std::span<const unsigned char> bytes) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string text;
  for (const unsigned char byte : bytes) {
    text += kDigits[byte >> 4U];
    text += kDigits[byte & 15U];
  }
  return text;
}

std::vector<unsigned char> bytesOf(std::string_view digits) {
  std::vector<unsigned char> bytes;
  for (std::size_t i = 0; i + 1 < digits.size(); i += 2) {
    unsigned char byte = 0;
    const auto [end, error] = std::from_chars(digits.data() + i, digits.data() + i + 2, byte, 16);
    if (error != std::errc() || end != digits.data() + i + 2) break;
    bytes.push_back(byte);
  }
  if (bytes.size() != kRandomBytes) throw DeviceError("PJLink: the greeting's random number is none");
  return bytes;
}

std::string digest(gnutls_digest_algorithm_t algorithm, const std::string& text) {
  std::vector<unsigned char> bytes(gnutls_hash_get_len(algorithm));
  if (gnutls_hash_fast(algorithm, text.data(), text.size(), bytes.data()) != 0) {
    throw DeviceError("PJLink: this machine's GnuTLS does not compute the digest that the projector asks for");
  }
  return hexOf(bytes);
}

}  // namespace

std::string pjlinkMd5(std::string_view random, std::string_view password) {
  return digest(GNUTLS_DIG_MD5, std::string(random) + std::string(password));
}

std::string pjlinkSha256(std::string_view theirRandom, std::string_view ourRandom, std::string_view password) {
  std::vector<unsigned char> mixed = bytesOf(theirRandom);
  const std::vector<unsigned char> ours = bytesOf(ourRandom);
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = static_cast<unsigned char>(mixed[i] ^ ours[i]);
  return std::string(ourRandom) + digest(GNUTLS_DIG_SHA256, hexOf(mixed) + std::string(password));
}

std::string pjlinkRandom() {
  std::array<unsigned char, kRandomBytes> bytes{};
  if (gnutls_rnd(GNUTLS_RND_NONCE, bytes.data(), bytes.size()) != 0) {
    throw DeviceError("PJLink: this machine has no random numbers to give");
  }
  return hexOf(bytes);
}

}  // namespace pixelflex::devices
