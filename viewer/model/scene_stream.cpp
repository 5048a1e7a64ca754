#include "viewer/model/scene_stream.h"

#include <unistd.h>

#include <cerrno>
#include <span>
#include <type_traits>

namespace pixelflex::viewer {
namespace {

enum class Outcome : std::uint8_t { kScene = 'S', kFailure = 'F' };

void write(int descriptor, std::span<const std::byte> bytes) {
  while (!bytes.empty()) {
    const auto written = ::write(descriptor, bytes.data(), bytes.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) throw SenderGone();
    bytes = bytes.subspan(static_cast<std::size_t>(written));
  }
}

void read(int descriptor, std::span<std::byte> bytes) {
  while (!bytes.empty()) {
    const auto got = ::read(descriptor, bytes.data(), bytes.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) throw SenderGone();
    bytes = bytes.subspan(static_cast<std::size_t>(got));
  }
}

template <class T>
void writeValue(int descriptor, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  write(descriptor, std::as_bytes(std::span(&value, 1)));
}

template <class T>
T readValue(int descriptor) {
  T value{};
  read(descriptor, std::as_writable_bytes(std::span(&value, 1)));
  return value;
}

template <class Values>
void writeAll(int descriptor, const Values& values) {
  writeValue(descriptor, std::uint64_t{values.size()});
  write(descriptor, std::as_bytes(std::span(values)));
}

template <class Values>
Values readAll(int descriptor) {
  Values values;
  values.resize(readValue<std::uint64_t>(descriptor));
  read(descriptor, std::as_writable_bytes(std::span(values)));
  return values;
}

}  // namespace

void sendScene(int descriptor, const Scene& scene) {
  writeValue(descriptor, Outcome::kScene);
  writeAll(descriptor, scene.vertices);
  writeAll(descriptor, scene.indices);
  writeAll(descriptor, scene.parts);
  writeAll(descriptor, scene.materials);
  writeValue(descriptor, std::uint64_t{scene.pictures.size()});
  for (const auto& picture : scene.pictures) {
    writeValue(descriptor, picture.size());
    writeValue(descriptor, std::int32_t{picture.channels()});
    write(descriptor, std::as_bytes(picture.samples()));
  }
  writeValue(descriptor, std::uint64_t{scene.warnings.size()});
  for (const auto& warning : scene.warnings) writeAll(descriptor, warning);
}

void sendFailure(int descriptor, const std::string& message) {
  writeValue(descriptor, Outcome::kFailure);
  writeAll(descriptor, message);
}

Scene receiveScene(int descriptor) {
  if (readValue<Outcome>(descriptor) == Outcome::kFailure) throw ModelError(readAll<std::string>(descriptor));
  Scene scene;
  scene.vertices = readAll<decltype(scene.vertices)>(descriptor);
  scene.indices = readAll<decltype(scene.indices)>(descriptor);
  scene.parts = readAll<decltype(scene.parts)>(descriptor);
  scene.materials = readAll<decltype(scene.materials)>(descriptor);
  const auto pictures = readValue<std::uint64_t>(descriptor);
  for (std::uint64_t i = 0; i < pictures; ++i) {
    const auto size = readValue<devices::Size>(descriptor);
    devices::Image8 picture(size, readValue<std::int32_t>(descriptor));
    read(descriptor, std::as_writable_bytes(picture.samples()));
    scene.pictures.push_back(std::move(picture));
  }
  const auto warnings = readValue<std::uint64_t>(descriptor);
  for (std::uint64_t i = 0; i < warnings; ++i) scene.warnings.push_back(readAll<std::string>(descriptor));
  return scene;
}

}  // namespace pixelflex::viewer
