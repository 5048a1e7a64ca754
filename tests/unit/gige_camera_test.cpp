#include "devices/serve/gige_camera.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <regex>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "devices/camera/aravis_camera.h"
#include "devices/camera/camera_error.h"
#include "devices/camera/cameras.h"
#include "devices/serve/gige_registers.h"
#include "devices/serve/gige_sender.h"
#include "tests/support/process.h"
#include "tests/support_devices/gige_place.h"

namespace pixelflex::testing {
namespace {

using devices::Camera;
using devices::GigeCamera;
using devices::Image8;
using devices::Size;
using ::testing::AllOf;
using ::testing::HasSubstr;

/// A picture that tells where each pixel is, how long it was exposed, and how many came before it.
Image8 telling(Size size, double seconds, int count) {
  Image8 image(size, 3);
  for (int y = 0; y < size.height; ++y) {
    for (int x = 0; x < size.width; ++x) {
      image.at(x, y, 0) = static_cast<std::uint8_t>(x * 7 + y * 13);
      image.at(x, y, 1) = static_cast<std::uint8_t>(std::lround(seconds * 1000));
      image.at(x, y, 2) = static_cast<std::uint8_t>(count);
    }
  }
  return image;
}

class GigeCameraTest : public ::testing::Test {
 protected:
  void serve(Size size = {640, 480}) {
    camera_ = std::make_unique<GigeCamera>(
        GigeCamera::Options{.serial = place_.serial, .size = size, .address = place_.address},
        [this, size](double seconds) { return telling(size, seconds, count_ = count_ + 1); },
        [](const std::string& what) { ADD_FAILURE() << what; });
  }
  [[nodiscard]] std::unique_ptr<Camera> open() const { return devices::openCamera("aravis:" + place_.address); }

  GigePlace place_;
  std::atomic<int> count_ = 0;
  std::unique_ptr<GigeCamera> camera_;
};

TEST_F(GigeCameraTest, PicturesComeAsTheyWereTaken) {
  serve();
  const auto camera = open();
  ASSERT_EQ(camera->size(), (Size{640, 480}));
  auto* control = camera->exposureControl();
  ASSERT_NE(control, nullptr);
  for (const double seconds : {0.002, 0.05, 0.2}) {
    EXPECT_NEAR(control->setExposure(seconds), seconds, 1e-6);
    EXPECT_NEAR(control->exposure(), seconds, 1e-6);
    const Image8 photo = camera->shoot();
    EXPECT_EQ(photo, telling({640, 480}, seconds, count_));
  }
}

TEST_F(GigeCameraTest, EachPhotographBeginsAfterItWasAskedFor) {
  serve({64, 48});
  const auto camera = open();
  for (int i = 0; i < 20; ++i) {
    const int before = count_;
    EXPECT_GT(camera->shoot().at(0, 0, 2), before);  // more than the next one when a frame was taken again
  }
}

TEST_F(GigeCameraTest, LargePicturesComeWhole) {
  const Size size{3000, 2000};
  serve(size);
  const auto camera = open();
  for (int i = 0; i < 2; ++i) {
    const Image8 photo = camera->shoot();
    EXPECT_EQ(photo, telling(size, 0.01, photo.at(0, 0, 2)));
  }
}

/// A search waits a fixed time for answers, and a busy machine may be late.
bool happensSoon(const std::function<bool()>& attempt) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (std::chrono::steady_clock::now() < deadline) {
    if (attempt()) return true;
  }
  return false;
}

bool opensWith(const std::string& name) {
  try {
    return devices::openCamera("aravis:" + name)->size() == Size{64, 48};
  } catch (const devices::CameraError&) {
    return false;
  }
}

TEST_F(GigeCameraTest, IsFoundByItsNames) {
  serve({64, 48});
  for (const auto& name : {camera_->name(), place_.serial, place_.address}) {
    EXPECT_TRUE(happensSoon([&] { return opensWith(name); })) << name;
  }
  EXPECT_TRUE(happensSoon([&] {
    return std::ranges::any_of(devices::listCameras(), [&](const auto& info) {
      return info.address == "aravis:" + camera_->name() && info.model == "PixelFlex Room at " + place_.address;
    });
  }));
}

/// Commands to every camera, and what one of them answers.
class Broadcast {
 public:
  Broadcast() {
    const int on = 1;
    ::setsockopt(socket_.descriptor(), SOL_SOCKET, SO_BROADCAST, &on, sizeof on);
  }
  void send(devices::GigeCommand command, const devices::Bytes& data) const {
    const auto code = static_cast<std::uint8_t>(command);
    devices::Bytes packet{0x42, 1, 0, code, 0, static_cast<std::uint8_t>(data.size()), 0, 1};
    packet.insert(packet.end(), data.begin(), data.end());
    sockaddr_in all{};
    all.sin_family = AF_INET;
    all.sin_port = htons(3956);
    all.sin_addr.s_addr = INADDR_BROADCAST;
    socket_.send(packet, all);
  }
  /// What was answered from `address`; 0: nothing soon.
  [[nodiscard]] int answerOf(const std::string& address) const {
    pollfd waiting{socket_.descriptor(), POLLIN, 0};
    while (::poll(&waiting, 1, 500) > 0) {
      std::array<std::uint8_t, 2048> packet{};
      sockaddr_in from{};
      socklen_t length = sizeof from;
      ::recvfrom(socket_.descriptor(), packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&from), &length);
      if (from.sin_addr.s_addr == ::inet_addr(address.c_str())) return packet[3];
    }
    return 0;
  }

 private:
  devices::UdpSocket socket_{"127.0.0.1", 0, false};
};

TEST_F(GigeCameraTest, BroadcastsFindItAndDoNothingElse) {
  serve({64, 48});
  const Broadcast broadcast;
  int answer = 0;
  for (int i = 0; i < 40 && answer == 0; ++i) {
    broadcast.send(devices::GigeCommand::kReadRegister, {0, 0, 0x0a, 0});
    broadcast.send(devices::GigeCommand::kDiscovery, {});
    answer = broadcast.answerOf(place_.address);
  }
  EXPECT_EQ(answer, static_cast<int>(devices::GigeCommand::kDiscovery) + 1);
}

TEST_F(GigeCameraTest, OneProgramHasItAtATime) {
  serve({64, 48});
  const auto first = open();
  try {
    (void)open();
    FAIL() << "opened twice";
  } catch (const devices::CameraError& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr("aravis:" + place_.address), HasSubstr("another program uses")));
  }
}

TEST_F(GigeCameraTest, AddressesAreGivenOnce) {
  serve({64, 48});
  try {
    const GigeCamera second({.serial = "2", .size = {64, 48}, .address = place_.address}, {}, {});
    FAIL() << "served twice";
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), AllOf(HasSubstr(place_.address), HasSubstr("in use")));
  }
}

TEST_F(GigeCameraTest, CamerasThatAreGoneAreNamed) {
  serve({64, 48});
  const auto camera = open();
  (void)camera->shoot();
  camera_.reset();
  try {
    (void)camera->shoot();
    FAIL() << "a photograph from a camera that is gone";
  } catch (const devices::CameraError& error) {
    EXPECT_THAT(error.what(), HasSubstr("aravis:" + place_.address + ": "));
  }
}

TEST_F(GigeCameraTest, ProgramsOfOthersUnderstandIt) {
  serve({320, 240});
  const Output features = run({"arv-tool-0.8", "-a", place_.address, "control", "Width", "Height", "PixelFormat",
                               "DeviceVendorName", "ExposureTimeAbs=5000", "ExposureTimeAbs"});
  EXPECT_EQ(features.status, 0) << features.text;
  EXPECT_THAT(features.text, AllOf(HasSubstr("Width = 320"), HasSubstr("Height = 240"), HasSubstr("RGB8"),
                                   HasSubstr("PixelFlex"), HasSubstr("ExposureTimeAbs = 5000")));
}

/// How many frames came whole to a program that streams for so long; `text` is what it said.
int framesStreamedToOthers(const std::string& address, int seconds, std::string& text) {
  // Their own socket buffer would be as small as this frame: less than a packet and its administration.
  const Output output = run({"arv-camera-test-0.8", "-n", address, "-f", "20", "--no-packet-socket", "-e", "3000", "-w",
                             "320", "-h", "240", "--duration=" + std::to_string(seconds)});
  text = output.text;
  std::smatch completed;
  const bool counted = std::regex_search(output.text, completed, std::regex(R"(n_completed_buffers *= *(\d+))"));
  return output.status == 0 && counted ? std::stoi(completed[1]) : 0;
}

TEST_F(GigeCameraTest, ProgramsOfOthersStreamFromIt) {
  serve({320, 240});
  int completed = 0;
  std::string text;
  for (int seconds = 3; completed < 3 && seconds <= 27; seconds *= 3) {  // a busy machine needs more
    completed = framesStreamedToOthers(place_.address, seconds, text);
  }
  EXPECT_GE(completed, 3) << text;
}

TEST(GigeRegisters, AddressesBeyondTheLastAreNobodys) {
  devices::GigeRegisters registers("1", {64, 48}, "127.0.0.1");
  for (const std::uint32_t address : {0xFFFFFFFCU, 0xFFFFFFFFU}) {
    registers.write(address, 7);
    EXPECT_EQ(registers.read(address), 0);
    EXPECT_FALSE(registers.writeBlock(address, devices::Bytes(8)));
    EXPECT_FALSE(registers.readBlock(address, 8));
  }
}

/// A camera that was not made here. It can be at one address only, and says nothing when that is taken: then another
/// one is started, until one has got it.
class CameraOfOthers {
 public:
  explicit CameraOfOthers(std::string serial) : serial_(std::move(serial)) {}
  [[nodiscard]] std::unique_ptr<Camera> open() {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(90);
    while (std::chrono::steady_clock::now() < deadline) {
      server_.reset();
      server_ = std::make_unique<Process>(
          std::vector<std::string>{"arv-fake-gv-camera-0.8", "-i", "127.0.0.1", "-s", serial_});
      for (int i = 0; i < 4; ++i) {
        try {
          return devices::openCamera("aravis:Aravis-Fake-" + serial_);
        } catch (const devices::CameraError&) {  // it is not there yet, or never will be
        }
      }
    }
    throw std::runtime_error("no camera of others can be started");
  }

 private:
  std::string serial_;
  std::unique_ptr<Process> server_;
};

TEST(AravisCamera, TakesPhotographsWithACameraOfOthers) {
  CameraOfOthers others(GigePlace().serial);
  const auto camera = others.open();
  EXPECT_EQ(camera->size(), (Size{2048, 2048}));
  EXPECT_NEAR(camera->exposureControl()->setExposure(0.02), 0.02, 1e-6);
  const Image8 one = camera->shoot();
  EXPECT_EQ(one.size(), camera->size());
  EXPECT_NE(one.at(10, 10), one.at(60, 10));  // its test picture is a ramp
}

}  // namespace
}  // namespace pixelflex::testing
