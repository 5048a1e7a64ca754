#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <system_error>
#include <vector>

#include "viewer/model/scene_import.h"

namespace pixelflex::viewer {
namespace {

constexpr const char* kCutOff = "; it is cut off or damaged: make or copy it again";

struct ModelFile {
  std::filesystem::path path;
  std::uintmax_t bytes = 0;
  std::ifstream stream;

  [[noreturn]] void fail(const std::string& what) const { throw ModelError(path.string() + ": " + what); }
  void require(std::uintmax_t needed, const std::string& promise) const {
    if (needed <= bytes) return;
    fail("promises " + promise + ", at least " + std::to_string(needed) + " bytes, but has " + std::to_string(bytes) +
         kCutOff);
  }
};

std::uint32_t littleEndian(const char* bytes) {
  std::uint32_t value = 0;
  for (unsigned i = 0; i < 4; ++i) value |= std::uint32_t{static_cast<unsigned char>(bytes[i])} << (8 * i);
  return value;
}

struct PlyElement {
  std::string name;
  std::uintmax_t count = 0;
  std::uintmax_t bytes = 0;  // of one, at least
};

std::uintmax_t bytesOfPlyType(const std::string& type) {
  if (type.find("64") != std::string::npos || type == "double") return 8;
  if (type.find('8') != std::string::npos || type == "char" || type == "uchar") return 1;
  return type.find("16") != std::string::npos || type.find("short") != std::string::npos ? 2 : 4;
}

/// A list of corners holds three at least; of other things, none.
std::uintmax_t bytesOfPlyProperty(std::istringstream& words) {
  std::string type;
  words >> type;
  if (type != "list") return bytesOfPlyType(type);
  std::string count;
  std::string item;
  std::string name;
  words >> count >> item >> name;
  return bytesOfPlyType(count) + (name.starts_with("vertex_ind") ? 3 * bytesOfPlyType(item) : 0);
}

struct PlyHeader {
  bool text = false;
  std::vector<PlyElement> elements;
};

PlyHeader readPlyHeader(ModelFile& file) {
  PlyHeader header;
  std::string line;
  constexpr int kMostLines = 10'000;
  for (int i = 0; i < kMostLines && std::getline(file.stream, line); ++i) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "end_header") return header;
    std::string name;
    if (key == "format") {
      words >> name;
      header.text = name == "ascii";
    }
    if (key == "element") {
      PlyElement element;
      words >> element.name >> element.count;
      if (words.fail()) file.fail("its header says \"" + line.substr(0, 80) + "\"" + kCutOff);
      header.elements.push_back(element);
    }
    if (key == "property" && !header.elements.empty()) header.elements.back().bytes += bytesOfPlyProperty(words);
  }
  file.fail(std::string("its header has no end") + kCutOff);
}

void checkPly(ModelFile& file) {
  const PlyHeader header = readPlyHeader(file);
  std::uintmax_t needed = static_cast<std::uintmax_t>(file.stream.tellg());
  std::string promise;
  std::uintmax_t lines = 0;
  for (const auto& element : header.elements) {
    const std::uintmax_t each = header.text ? 2 : element.bytes;
    if (each > 0 && element.count > file.bytes)
      file.require(element.count, std::to_string(element.count) + " of " + element.name);
    needed += element.count * each;
    lines += element.count;
    promise += (promise.empty() ? "" : " and ") + std::to_string(element.count) + " of " + element.name;
  }
  file.require(needed, promise);
  if (!header.text) return;
  std::uintmax_t found = 0;
  for (std::string line; found < lines && std::getline(file.stream, line);)
    found += line.empty() || line == "\r" ? 0 : 1;
  if (found < lines) {
    file.fail("promises " + promise + " but has only " + std::to_string(found) + " lines" + kCutOff);
  }
}

void checkStl(ModelFile& file, const std::string& start) {
  constexpr std::uintmax_t kHeader = 84;
  std::string head(kHeader, '\0');
  file.stream.read(head.data(), kHeader);
  const bool whole = file.stream.gcount() == static_cast<std::streamsize>(kHeader);
  if (start.starts_with("solid") && file.bytes > kHeader) {
    std::string tail(static_cast<std::size_t>(std::min<std::uintmax_t>(file.bytes, 256)), '\0');
    file.stream.clear();
    file.stream.seekg(-static_cast<std::streamoff>(tail.size()), std::ios::end);
    file.stream.read(tail.data(), static_cast<std::streamsize>(tail.size()));
    if (tail.find("endsolid") != std::string::npos) return;
  }
  if (!whole) file.fail(std::string("too short for an STL") + kCutOff);
  const std::uintmax_t triangles = littleEndian(&head[80]);
  file.require(kHeader + 50 * triangles, std::to_string(triangles) + " triangles");
}

void checkGlb(ModelFile& file) {
  std::array<char, 12> head{};
  file.stream.read(head.data(), head.size());
  if (file.stream.gcount() != static_cast<std::streamsize>(head.size())) file.fail(std::string("too short") + kCutOff);
  file.require(littleEndian(&head[8]), "a binary glTF");
}

}  // namespace

void checkModelFile(const std::filesystem::path& path) {
  ModelFile file{.path = path};
  std::error_code error;
  if (!std::filesystem::exists(path, error)) file.fail("there is no such file");
  if (!std::filesystem::is_regular_file(path, error)) file.fail("not a file: name the model inside it");
  file.bytes = std::filesystem::file_size(path, error);
  if (error) file.fail(error.message());
  if (file.bytes == 0) file.fail("the file is empty: make or copy it again");
  if (file.bytes > kLargestModelFile) file.fail("larger than 16 GiB: make the model simpler");
  file.stream.open(path, std::ios::binary);
  std::string start(5, '\0');
  file.stream.read(start.data(), static_cast<std::streamsize>(start.size()));
  if (!file.stream.is_open() || file.stream.bad()) file.fail("cannot be opened for reading");
  file.stream.clear();
  file.stream.seekg(0);
  std::string extension = path.extension().string();
  std::ranges::transform(extension, extension.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == ".ply") checkPly(file);
  if (extension == ".stl") checkStl(file, start);
  if (start.starts_with("glTF")) checkGlb(file);
}

}  // namespace pixelflex::viewer
