#include <gtest/gtest.h>

#include "tests/support/desktop_mirror.h"
#include "tests/support/x_servers.h"

namespace pixelflex {
namespace {

using testing::DesktopMirror;
using testing::XServer;
using testing::XvncOptions;
using testing::XvncServer;

// Clients with text, curves and edges, and a window that can be moved.
void fillDesktop(XServer& x) {
  x.query({"xsetroot", "-mod", "16", "12", "-fg", "steel blue", "-bg", "wheat"});
  x.start({"xterm", "-geometry", "80x24+30+40", "-e", "sh", "-c", "seq 1 2000; sleep 1000"});
  x.start({"xlogo", "-geometry", "200x200+600+300"});
  x.query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xlogo"});
  x.query({"xdotool", "search", "--sync", "--onlyvisible", "--class", "xterm"});
}

void moveLogo(XServer& x, int left, int top) {
  x.query({"xdotool", "search", "--class", "xlogo", "windowmove", "--sync", std::to_string(left), std::to_string(top)});
}

TEST(Xvnc, ShowsTheDesktopBitForBitOverAUnixSocket) {
  XvncServer server;
  fillDesktop(server.x());
  DesktopMirror mirror(server.unixAddress());
  ASSERT_TRUE(mirror.pumpUntilEqual(server.x().display())) << mirror.summary();
  moveLogo(server.x(), 100, 420);
  EXPECT_TRUE(mirror.pumpUntilEqual(server.x().display()));
}

}  // namespace
}  // namespace pixelflex
