// Slow ways to a real server.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/support/desktop_mirror.h"
#include "tests/support/slow_relay.h"
#include "tests/support/x_servers.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::paintNoise;
using pixelflex::testing::SlowRelay;
using pixelflex::testing::XvncServer;
using namespace std::chrono_literals;

int portOf(const std::string& address) {
  return std::stoi(address.substr(address.rfind(':') + 1));
}

class SlowLink : public ::testing::Test {
 protected:
  static SessionOptions optionsFor(const SlowRelay& relay) {
    SessionOptions options{.server = parseServerAddress(relay.address())};
    options.lossless = false;
    options.loopbackIsLocal = false;
    return options;
  }
  // Noise after noise until the connection's settings have changed.
  std::optional<LinkChanged> adaptation(DesktopMirror& mirror) {
    unsigned seed = 1;
    for (auto begun = mirror.updates(); seed < 60 && !mirror.last<LinkChanged>(); ++seed) {
      paintNoise(server_.x().display(), seed);
      mirror.pumpUntil([&] { return mirror.updates() > begun || mirror.last<LinkChanged>(); });
      begun = mirror.updates();
    }
    return mirror.last<LinkChanged>();
  }

  XvncServer server_{{.size = {400, 300}, .unixSocket = false, .tcp = true}};
};

TEST_F(SlowLink, IsMeasuredAndSaid) {
  const SlowRelay relay(portOf(server_.tcpAddress()), {.bytesPerSecond = 400e3, .delay = 15ms});
  DesktopMirror mirror(optionsFor(relay));
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > 0; })) << mirror.summary();
  const auto changed = adaptation(mirror);
  ASSERT_TRUE(changed.has_value()) << mirror.summary();
  double megabits = 0, milliseconds = 0;
  int quality = 0;
  ASSERT_EQ(
      std::sscanf(changed->message.c_str(), "the connection carries %lf Mbit/s, %lf ms there and back: JPEG quality %d",
                  &megabits, &milliseconds, &quality),
      3)
      << changed->message;
  EXPECT_LE(megabits, 3.6);  // 3.2 in truth, less on a busy machine
  EXPECT_GE(milliseconds, 30);
  EXPECT_LE(quality, 5);
}

TEST_F(SlowLink, LosslessArrivesBitForBit) {
  const SlowRelay relay(portOf(server_.tcpAddress()), {.bytesPerSecond = 1.5e6, .delay = 5ms});
  SessionOptions options = optionsFor(relay);
  options.lossless = true;
  DesktopMirror mirror(options);
  paintNoise(server_.x().display(), 7);
  EXPECT_TRUE(mirror.pumpUntilEqual(server_.x().display())) << mirror.summary();
}

TEST_F(SlowLink, AnotherQualityChangesThePixels) {
  SessionOptions options{.server = parseServerAddress(server_.tcpAddress())};
  options.lossless = false;
  options.link = Link::kWan;
  paintNoise(server_.x().display(), 7);
  const devices::Image8 truth = pixelflex::testing::grabRoot(server_.x().display());
  const auto differing = [&truth](const DesktopMirror& mirror) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < truth.samples().size(); ++i)
      count += truth.samples()[i] != mirror.desktop().samples()[i];
    return count;
  };
  DesktopMirror lossy(options);
  ASSERT_TRUE(lossy.pumpUntil([&] { return lossy.updates() > 0; }));
  EXPECT_GT(differing(lossy), truth.samples().size() / 2);
  options.link = Link::kAuto;
  DesktopMirror local(options);
  ASSERT_TRUE(local.pumpUntil([&] { return local.updates() > 0; }));
  EXPECT_EQ(differing(local), 0U) << "within this machine nothing is lost";
}

}  // namespace
}  // namespace pixelflex::viewer
