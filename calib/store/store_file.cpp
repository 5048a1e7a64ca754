#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <system_error>

#include "calib/store/store.h"
#include "calib/store/yaml_document.h"
#include "calib/store/yaml_reader.h"
#include "devices/image/atomic_file.h"

namespace pixelflex::calib {
namespace {

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& message) {
  throw StoreError({{path.string(), 0, 0, message}});
}

std::filesystem::path wallFile(const std::filesystem::path& folder) {
  return folder / "wall.yaml";
}
std::filesystem::path calibrationFile(const std::filesystem::path& folder) {
  return folder / "calibration.yaml";
}

void save(const std::filesystem::path& path, const std::string& text) {
  try {
    devices::writeFileAtomically(path, text);
  } catch (const std::system_error& error) {
    throw StoreError({{"", 0, 0, error.what()}});  // names the file already
  }
}

}  // namespace

std::string readStoreFile(const std::string& path) {
  if (std::filesystem::is_directory(path)) fail(path, "this is a folder, not a file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rbe"), &std::fclose);
  if (file == nullptr) fail(path, std::string("cannot open: ") + std::strerror(errno));
  std::string text;
  constexpr std::size_t kChunk = std::size_t{1} << 16;
  for (std::size_t count = kChunk; count == kChunk;) {
    const std::size_t before = text.size();
    if (before > kMaxStoreBytes) fail(path, "larger than 64 MiB");
    text.resize(before + kChunk);
    count = std::fread(text.data() + before, 1, kChunk, file.get());
    text.resize(before + count);
  }
  if (std::ferror(file.get()) != 0) fail(path, std::string("cannot read: ") + std::strerror(errno));
  return text;
}

Wall loadWall(const std::filesystem::path& folder) {
  const auto path = wallFile(folder);
  if (!std::filesystem::exists(path)) {
    fail(path, "there is no such file; make the wall's folder with: pixelflex new " + folder.string());
  }
  return parseWall(readStoreFile(path.string()), path.string());
}

bool hasCalibration(const std::filesystem::path& folder) {
  return std::filesystem::exists(calibrationFile(folder));
}

Calibration loadCalibration(const std::filesystem::path& folder) {
  const auto path = calibrationFile(folder);
  if (!hasCalibration(folder)) {
    fail(path, "the wall is not calibrated yet: run pixelflex calibrate " + folder.string());
  }
  Calibration calibration = parseCalibration(readStoreFile(path.string()), path.string());
  const Nudges nudges = loadNudges(folder);
  for (auto& projector : calibration.projectors) {
    if (const auto found = nudges.find(projector.name); found != nudges.end()) projector.nudge = found->second;
  }
  return calibration;
}

// What is saved must load again, so the text is parsed, and thereby validated, before it replaces a good file.

void saveWall(const std::filesystem::path& folder, const Wall& wall) {
  const auto path = wallFile(folder);
  const std::string text = formatWall(wall);
  (void)parseWall(text, path.string());
  save(path, text);
}

void saveCalibration(const std::filesystem::path& folder, const Calibration& calibration) {
  const auto path = calibrationFile(folder);
  const std::string text = formatCalibration(calibration);
  (void)parseCalibration(text, path.string());
  save(path, text);
}

}  // namespace pixelflex::calib
