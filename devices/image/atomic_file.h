#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>

namespace pixelflex::devices {

/// Replaces `path` with `bytes` in one step: temporary file beside it, fsync, rename, fsync of the folder. A killed
/// program leaves the old file or the new one, never half. Parent folders are created. Throws std::system_error, whose
/// what() names the file.
void writeFileAtomically(const std::filesystem::path& path, std::span<const std::byte> bytes);
void writeFileAtomically(const std::filesystem::path& path, std::string_view text);

}  // namespace pixelflex::devices
