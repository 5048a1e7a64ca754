#include "viewer/vnc/vnc_auth.h"

#include <gnutls/crypto.h>
#include <gnutls/gnutls.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace pixelflex::viewer {
namespace {

using Block = std::array<std::uint8_t, 8>;

enum class Direction { kEncrypt, kDecrypt };

// VNC gives DES its key with the bits of each byte in reverse.
std::uint8_t reversed(std::uint8_t byte) {
  unsigned result = 0;
  for (unsigned bit = 0; bit < 8; ++bit) result |= (byte >> bit & 1u) << (7 - bit);
  return static_cast<std::uint8_t>(result);
}

// One block of DES: chained to a block of zeros, it is the plain cipher.
Block des(Block block, Block key, Direction direction) {
  Block zeros{};
  std::ranges::transform(key, key.begin(), reversed);
  const gnutls_datum_t keyDatum{key.data(), static_cast<unsigned>(key.size())};
  const gnutls_datum_t zeroDatum{zeros.data(), static_cast<unsigned>(zeros.size())};
  gnutls_cipher_hd_t cipher = nullptr;
  if (::gnutls_cipher_init(&cipher, GNUTLS_CIPHER_DES_CBC, &keyDatum, &zeroDatum) < 0) {
    throw std::runtime_error("GnuTLS has no DES here, which VNC's password scheme needs");
  }
  const int result = direction == Direction::kEncrypt ? ::gnutls_cipher_encrypt(cipher, block.data(), block.size())
                                                      : ::gnutls_cipher_decrypt(cipher, block.data(), block.size());
  ::gnutls_cipher_deinit(cipher);
  wipe(key);
  if (result < 0) throw std::runtime_error(std::string("DES: ") + ::gnutls_strerror(result));
  return block;
}

}  // namespace

std::array<std::uint8_t, 16> answerVncChallenge(std::span<const std::uint8_t, 16> challenge,
                                                std::string_view password) {
  Block key{};
  std::memcpy(key.data(), password.data(), std::min(password.size(), key.size()));
  std::array<std::uint8_t, 16> answer{};
  for (std::size_t half = 0; half < 16; half += 8) {
    Block block{};
    std::copy_n(challenge.begin() + static_cast<std::ptrdiff_t>(half), 8, block.begin());
    std::ranges::copy(des(block, key, Direction::kEncrypt), answer.begin() + static_cast<std::ptrdiff_t>(half));
  }
  wipe(key);
  return answer;
}

Secret revealVncPassword(std::span<const std::uint8_t, 8> hidden) {
  constexpr Block kKnownToAll{23, 82, 107, 6, 35, 78, 88, 7};
  Block block{};
  std::ranges::copy(hidden, block.begin());
  Block plain = des(block, kKnownToAll, Direction::kDecrypt);
  Secret password(std::string_view(reinterpret_cast<const char*>(plain.data()),
                                   static_cast<std::size_t>(std::ranges::find(plain, 0) - plain.begin())));
  wipe(plain);
  return password;
}

}  // namespace pixelflex::viewer
