#include "devices/serve/gige_registers.h"

#include <arv.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace pixelflex::devices {
namespace {

constexpr std::uint32_t kMono8 = 0x01080001;
constexpr std::uint32_t kMono16 = 0x01100007;
constexpr std::uint32_t kRgb8 = 0x02180014;
constexpr std::uint32_t kBayerFirst = 0x01080008;  // GR, RG, GB, BG
constexpr std::uint32_t kBayerLast = 0x0108000b;
constexpr std::uint32_t kPacketSizeAtFirst = 8000;
constexpr std::uint32_t kDescription = ARV_FAKE_CAMERA_MEMORY_SIZE;  // behind the registers
constexpr std::uint32_t kOneFrame = 2;

/// Texts of fixed places and lengths.
void writeText(ArvFakeCamera* camera, std::uint32_t address, std::size_t length, std::string_view text) {
  std::array<char, 32> field{};
  text.copy(field.data(), std::min(length, field.size()) - 1);
  arv_fake_camera_write_memory(camera, address, static_cast<guint32>(length), field.data());
}

/// The channel that a Bayer mosaic has at a pixel.
int mosaicChannel(std::uint32_t format, int x, int y) {
  const std::uint32_t order = format - kBayerFirst;
  const bool redInOddColumns = order == 0 || order == 3;
  const bool redInOddRows = order >= 2;
  const bool column = (x % 2 == 1) == redInOddColumns;
  const bool row = (y % 2 == 1) == redInOddRows;
  if (column != row) return 1;
  return row ? 0 : 2;
}

void appendPixel(Bytes& bytes, std::uint32_t format, const std::uint8_t* colour, int x, int y) {
  if (format == kRgb8) {
    bytes.insert(bytes.end(), colour, colour + 3);
  } else if (format >= kBayerFirst && format <= kBayerLast) {
    bytes.push_back(colour[mosaicChannel(format, x, y)]);
  } else {
    const auto grey = static_cast<std::uint8_t>((299 * colour[0] + 587 * colour[1] + 114 * colour[2] + 500) / 1000);
    bytes.insert(bytes.end(), format == kMono16 ? 2 : 1, grey);
  }
}

}  // namespace

struct GigeRegisters::Bank {
  explicit Bank(const std::string& serial) : camera(arv_fake_camera_new(serial.c_str())) {}
  ~Bank() { g_object_unref(camera); }
  Bank(const Bank&) = delete;
  Bank& operator=(const Bank&) = delete;
  [[nodiscard]] std::uint32_t read(std::uint32_t address) const {
    guint32 value = 0;
    arv_fake_camera_read_register(camera, address, &value);
    return value;
  }
  ArvFakeCamera* camera;
};

GigeRegisters::GigeRegisters(const std::string& serial, Size size, const std::string& address)
    : bank_(std::make_unique<Bank>(serial)) {
  ArvFakeCamera* camera = bank_->camera;
  writeText(camera, 0x48, 32, "PixelFlex");
  writeText(camera, 0x68, 32, "Room");
  for (const auto width : {ARV_FAKE_CAMERA_REGISTER_SENSOR_WIDTH, ARV_FAKE_CAMERA_REGISTER_WIDTH}) {
    arv_fake_camera_write_register(camera, static_cast<guint32>(width), static_cast<guint32>(size.width));
  }
  for (const auto height : {ARV_FAKE_CAMERA_REGISTER_SENSOR_HEIGHT, ARV_FAKE_CAMERA_REGISTER_HEIGHT}) {
    arv_fake_camera_write_register(camera, static_cast<guint32>(height), static_cast<guint32>(size.height));
  }
  arv_fake_camera_write_register(camera, ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT, kRgb8);
  arv_fake_camera_write_register(camera, kPacketSize, kPacketSizeAtFirst);
  GInetAddress* place = g_inet_address_new_from_string(address.c_str());
  if (place != nullptr) arv_fake_camera_set_inet_address(camera, place);
  g_clear_object(&place);
}

GigeRegisters::~GigeRegisters() = default;

std::uint32_t GigeRegisters::read(std::uint32_t address) const {
  const std::scoped_lock lock(mutex_);
  return address <= kDescription - 4 ? bank_->read(address) : 0;
}

void GigeRegisters::write(std::uint32_t address, std::uint32_t value) {
  const std::scoped_lock lock(mutex_);
  if (address < kDescription - 4) arv_fake_camera_write_register(bank_->camera, address, value);
}

std::optional<Bytes> GigeRegisters::readBlock(std::uint32_t address, std::uint32_t size) const {
  const std::scoped_lock lock(mutex_);
  std::size_t described = 0;
  const char* text = arv_fake_camera_get_genicam_xml(bank_->camera, &described);
  Bytes bytes(size);
  if (address < kDescription) {
    if (size == 0 || size >= kDescription - address) return std::nullopt;
    arv_fake_camera_read_memory(bank_->camera, address, size, bytes.data());
    return bytes;
  }
  const std::size_t begin = address - kDescription;
  if (begin >= described) return std::nullopt;
  std::copy_n(text + begin, std::min<std::size_t>(size, described - begin), bytes.begin());  // clients round sizes up
  return bytes;
}

bool GigeRegisters::writeBlock(std::uint32_t address, const Bytes& bytes) {
  const std::scoped_lock lock(mutex_);
  if (address >= kDescription || bytes.empty() || bytes.size() >= kDescription - address) return false;
  return arv_fake_camera_write_memory(bank_->camera, address, static_cast<guint32>(bytes.size()), bytes.data()) != 0;
}

bool GigeRegisters::acquires() const {
  return read(kPrivilege) != 0 && read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION) != 0;
}

void GigeRegisters::stopAcquisition() {
  write(ARV_FAKE_CAMERA_REGISTER_ACQUISITION, 0);
}

bool GigeRegisters::wantsOneFrame() const {
  return read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_MODE) == kOneFrame;
}

bool GigeRegisters::isTriggered() const {
  const std::scoped_lock lock(mutex_);
  return arv_fake_camera_is_in_free_running_mode(bank_->camera) == 0;
}

bool GigeRegisters::takeTrigger() {
  const std::scoped_lock lock(mutex_);
  return arv_fake_camera_is_in_software_trigger_mode(bank_->camera) != 0 &&
         arv_fake_camera_check_and_acknowledge_software_trigger(bank_->camera) != 0;
}

double GigeRegisters::framePeriod() const {
  return 1e-6 * read(ARV_FAKE_CAMERA_REGISTER_ACQUISITION_FRAME_PERIOD_US);
}

double GigeRegisters::exposure() const {
  return 1e-6 * read(ARV_FAKE_CAMERA_REGISTER_EXPOSURE_TIME_US);
}

GigeFrame GigeRegisters::frameOf(const Image8& photo) const {
  GigeFrame frame;
  frame.pixelFormat = read(ARV_FAKE_CAMERA_REGISTER_PIXEL_FORMAT);
  frame.width = read(ARV_FAKE_CAMERA_REGISTER_WIDTH);
  frame.height = read(ARV_FAKE_CAMERA_REGISTER_HEIGHT);
  frame.x = read(ARV_FAKE_CAMERA_REGISTER_X_OFFSET);
  frame.y = read(ARV_FAKE_CAMERA_REGISTER_Y_OFFSET);
  frame.packetSize = std::clamp<std::size_t>(read(kPacketSize) & 0xffffU, 576, 16000);
  const Size size{static_cast<int>(std::min<std::uint32_t>(frame.width, static_cast<std::uint32_t>(photo.width()))),
                  static_cast<int>(std::min<std::uint32_t>(frame.height, static_cast<std::uint32_t>(photo.height())))};
  frame.width = static_cast<std::uint32_t>(size.width);
  frame.height = static_cast<std::uint32_t>(size.height);
  frame.pixels.reserve(static_cast<std::size_t>(size.area()) * 3);
  constexpr std::array<std::uint8_t, 3> kNothing{};
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      const auto u = static_cast<std::int64_t>(frame.x) + x;
      const auto v = static_cast<std::int64_t>(frame.y) + y;
      const bool inside = u < photo.width() && v < photo.height();
      const std::uint8_t* colour = inside ? &photo.at(static_cast<int>(u), static_cast<int>(v)) : kNothing.data();
      appendPixel(frame.pixels, frame.pixelFormat, colour, x, y);
    }
  }
  return frame;
}

}  // namespace pixelflex::devices
