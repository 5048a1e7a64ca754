#pragma once

#include <gmock/gmock.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/support/temporary_folder.h"
#include "viewer/model/scene_file.h"

namespace pixelflex::viewer {

inline const std::string kCube =
    "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
    "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 4 8 7 3\nf 1 5 8 4\nf 2 3 7 6\n";

class ModelFilesTest : public ::testing::Test {
 protected:
  std::filesystem::path file(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
    return folder_ / name;
  }
  Scene load(const std::string& name, const std::string& bytes) {
    const std::array files{file(name, bytes)};
    return loadScene(files);
  }
  std::string failure(const std::string& name, const std::string& bytes) {
    try {
      (void)load(name, bytes);
    } catch (const ModelError& error) {
      return error.what();
    }
    return "no error";
  }
  testing::TemporaryFolder folder_;
};

template <class T>
std::string bytesOf(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}

inline std::string binaryPly(const std::string& counts, const std::string& body) {
  return "ply\nformat binary_little_endian 1.0\n" + counts + body;
}

inline std::string plyHeader(std::uint64_t vertices, std::uint64_t faces) {
  return "element vertex " + std::to_string(vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

}  // namespace pixelflex::viewer
