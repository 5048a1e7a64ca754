#include <gmock/gmock.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <string>

#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using viewer::Closed;
using viewer::CloseKind;
using viewer::Connected;
using viewer::Lost;
using viewer::SecurityLevel;

TEST(XvncReconnect, AnEncryptedServerMayNotComeBackInTheClear) {
  const TemporaryFolder folder;
  const std::string path = (folder / "vnc.sock").string();
  const auto start = [&path](const std::string& security) {
    return std::make_unique<XvncServer>(XvncOptions{
        .size = {320, 240}, .unixSocket = false, .more = {"-rfbunixpath", path, "-SecurityTypes", security}});
  };
  auto server = start("TLSNone");
  viewer::SessionOptions options;
  options.server = viewer::parseServerAddress("unix:" + path);
  options.retry = viewer::Retry::kLost;
  DesktopMirror mirror(options);
  const auto connections = [&mirror] {
    return std::ranges::count_if(mirror.events(), [](const auto& e) { return std::holds_alternative<Connected>(e); });
  };
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.updates() > 0; })) << mirror.summary();
  ASSERT_EQ(mirror.last<Connected>()->security.level, SecurityLevel::kTls);
  server->x().process().signal(SIGKILL);
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Lost>().has_value(); })) << mirror.summary();
  server = start("TLSNone");
  ASSERT_TRUE(mirror.pumpUntil([&] { return connections() == 2; })) << mirror.summary();
  server->x().process().signal(SIGKILL);
  server = start("None");
  ASSERT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Closed>()->kind, CloseKind::kUntrusted) << mirror.summary();
}

}  // namespace
}  // namespace pixelflex::testing
