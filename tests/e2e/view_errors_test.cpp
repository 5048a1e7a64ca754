#include <gmock/gmock.h>

#include "tests/e2e/programs.h"
#include "tests/support/fake_vnc_server.h"
#include "tests/support/free_port.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
namespace fs = std::filesystem;

class ViewErrorsTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "640x480"}).status, 0); }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  void expectError(const std::string& server, const std::vector<std::string>& words, int status = 1) {
    const Output run = runProgram("view", {wall().string(), server, "--source", "vnc", "--headless", "--screenshot",
                                           (folder_ / "shot").string()});
    EXPECT_EQ(run.status, status);
    if (status == 1) {
      EXPECT_THAT(run.text, StartsWith("pixelflex-view: "));
    }
    for (const auto& word : words) EXPECT_THAT(run.text, HasSubstr(word));
    EXPECT_FALSE(fs::exists(folder_ / "shot"));
  }
  const TemporaryFolder folder_;
};

TEST_F(ViewErrorsTest, UnknownHost) {
  expectError("no-such-host.invalid:1", {"no-such-host.invalid"});
}

TEST_F(ViewErrorsTest, RefusedPort) {
  const std::string port = std::to_string(freePort());
  expectError("127.0.0.1::" + port, {"nothing listens", port});
}

TEST_F(ViewErrorsTest, MissingSocket) {
  expectError("unix:" + (folder_ / "none").string(), {"none"});
}

TEST_F(ViewErrorsTest, AnAddressThatIsNone) {
  expectError("host:", {"host:"}, 2);
}

TEST_F(ViewErrorsTest, ClosesInTheMiddleOfTheHandshake) {
  FakeVncServer server([](FakeConnection& client) { client.send(Message().text("RFB 003.0")); });
  expectError(server.address(), {"closed"});
}

TEST_F(ViewErrorsTest, ClosesInTheMiddleOfAnUpdate) {
  FakeVncServer server([](FakeConnection& client) {
    (void)client.shakeHands({640, 480});
    client.send(Message().update(1).rect(0, 0, 640, 480, 0).repeat(7, 1000));
  });
  expectError(server.address(), {"closed"});
}

TEST_F(ViewErrorsTest, DesktopTooLarge) {
  FakeVncServer server([](FakeConnection& client) { (void)client.shakeHands({20000, 1000}); });
  expectError(server.address(), {"20000x1000", "16384"});
}

TEST_F(ViewErrorsTest, PasswordAskedButNotGiven) {
  XvncServer server({.size = {640, 480}, .password = "secret"});
  expectError(server.unixAddress(), {"password"});
}

TEST_F(ViewErrorsTest, InvalidYamlIsNamedWithItsLine) {
  writeText(wall() / "wall.yaml", "format: pixelflex-wall\nversion: 1\nprojectors: [\n");
  expectError("localhost:1", {"wall.yaml:"});
}

TEST_F(ViewErrorsTest, UnreadableCalibration) {
  fs::remove(wall() / "calibration.yaml");
  fs::create_directory(wall() / "calibration.yaml");
  expectError("localhost:1", {"calibration.yaml"});
}

TEST_F(ViewErrorsTest, MissingCalibrationSaysWhatToRun) {
  fs::remove(wall() / "calibration.yaml");
  expectError("localhost:1", {"run pixelflex calibrate"});
}

TEST_F(ViewErrorsTest, AProjectorThatDoesNotExist) {
  const Output run = runProgram("view", {wall().string(), "localhost:1", "--headless", "--projectors", "p9"});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("p9"));
}

TEST_F(ViewErrorsTest, APasswordFileThatOthersCanRead) {
  writeText(folder_ / "password", "secret\n");
  fs::permissions(folder_ / "password", fs::perms(0644));
  const Output run = runProgram(
      "view", {wall().string(), "localhost:1", "--headless", "--password-file", (folder_ / "password").string()});
  EXPECT_EQ(run.status, 1);
  EXPECT_THAT(run.text, HasSubstr("chmod 600"));
}

}  // namespace
}  // namespace pixelflex::testing
