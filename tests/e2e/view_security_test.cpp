// Passwords and certificates as users of pixelflex view meet them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>

#include "tests/e2e/programs.h"
#include "tests/e2e/view_lost.h"
#include "tests/support/certificates.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/x_servers.h"

namespace pixelflex::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
namespace fs = std::filesystem;

class ViewSecurityTest : public ::testing::Test {
 protected:
  void SetUp() override { ASSERT_EQ(runProgram("new", {wall().string(), "--flat", "320x240"}).status, 0); }
  [[nodiscard]] fs::path wall() const { return folder_ / "wall"; }
  [[nodiscard]] std::vector<std::string> command(const std::string& server,
                                                 const std::vector<std::string>& more) const {
    std::vector<std::string> words{std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view",
                                   wall().string(),
                                   server,
                                   "--source",
                                   "vnc",
                                   "--headless",
                                   "--screenshot",
                                   (folder_ / "shot").string(),
                                   "--settle",
                                   "0"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  [[nodiscard]] Output view(const std::string& server, const std::vector<std::string>& more,
                            std::vector<std::string> environment = {}) const {
    environment.push_back("XDG_CONFIG_HOME=" + (folder_ / "config").string());
    return run(command(server, more), environment, std::chrono::seconds(100));
  }
  [[nodiscard]] std::string passwordFile(const std::string& content, fs::perms mode) const {
    const fs::path file = folder_ / "secret";
    writeText(file, content);
    fs::permissions(file, mode);
    return file.string();
  }
  const TemporaryFolder folder_;
};

constexpr auto kPrivate = fs::perms::owner_read | fs::perms::owner_write;

TEST_F(ViewSecurityTest, TakesThePasswordFromAFileOrTheEnvironment) {
  const XvncServer server({.size = {320, 240}, .password = "sesame"});
  const std::string& address = server.unixAddress();
  EXPECT_EQ(view(address, {"--password-file", passwordFile("sesame\nnot this\n", kPrivate)}).status, 0);
  EXPECT_EQ(view(address, {"--password-file", passwordFile("sesame", kPrivate)}).status, 0);
  const fs::path hidden = folder_ / "hidden";
  ASSERT_EQ(run({"x11vnc", "-storepasswd", "sesame", hidden.string()}).status, 0);
  fs::permissions(hidden, kPrivate);
  EXPECT_EQ(view(address, {"--password-file", hidden.string()}).status, 0) << "as vncpasswd writes it";
  EXPECT_EQ(view(address, {}, {"PIXELFLEX_VNC_PASSWORD=sesame"}).status, 0);
  const Output wrong = view(address, {}, {"PIXELFLEX_VNC_PASSWORD=wrong"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.text, HasSubstr("refused the password"));
  EXPECT_THAT(wrong.text, Not(HasSubstr("wrong")));
}

TEST_F(ViewSecurityTest, LeavesNoPasswordInItsEnvironment) {
  const XvncServer server({.size = {320, 240}, .password = "sesame"});
  const fs::path log = folder_ / "log";
  const Process viewer({std::string(PIXELFLEX_BIN_DIR) + "/pixelflex-view", (folder_ / "wall").string(),
                        server.unixAddress(), "--headless", "--stats"},
                       {.environment = {"PIXELFLEX_VNC_PASSWORD=sesame"}, .log = log});
  ASSERT_TRUE(waitUntil([&] { return textOf(log).find("the first picture") != std::string::npos; })) << textOf(log);
  const std::string environment = textOf("/proc/" + std::to_string(viewer.pid()) + "/environ");
  EXPECT_THAT(environment, HasSubstr("PATH="));
  EXPECT_THAT(environment, Not(HasSubstr("sesame")));
}

TEST_F(ViewSecurityTest, RefusesAPasswordFileThatIsNoSecret) {
  const std::string open = passwordFile("sesame\n", kPrivate | fs::perms::group_read);
  Output refused = view("localhost:1", {"--password-file", open});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.text, HasSubstr("run chmod 600 " + open));
  EXPECT_THAT(view("localhost:1", {"--password-file", passwordFile("\n", kPrivate)}).text, HasSubstr("no password"));
  EXPECT_THAT(view("localhost:1", {"--password-file", folder_.path().string()}).text, HasSubstr("not a password file"));
  EXPECT_THAT(view("localhost:1", {"--password-file", "/nowhere/secret"}).text, HasSubstr("no such password file"));
}

TEST_F(ViewSecurityTest, RemembersACertificateAndIsLoudWhenItChanges) {
  const Certificates first;
  const Certificates second;
  const std::string socket = (folder_ / "wall.sock").string();
  const auto options = [&socket](const Certificates& used) {
    return XvncOptions{.size = {320, 240},
                       .unixSocket = false,
                       .more = {"-SecurityTypes", "X509None,None", "-X509Cert", used.certificate(), "-X509Key",
                                used.key(), "-rfbunixpath", socket}};
  };
  const std::string address = "unix:" + socket;
  {
    const XvncServer server(options(first));
    const Output met = view(address, {});
    ASSERT_EQ(met.status, 0) << met.text;
    EXPECT_THAT(met.text, HasSubstr("is new here. Its certificate, SHA256:" + first.fingerprint()));
    const Output again = view(address, {"--require", "x509"});
    EXPECT_EQ(again.status, 0);
    EXPECT_THAT(again.text, Not(HasSubstr("SHA256")));
    EXPECT_EQ(view(address, {"--tls-ca", first.authority()}).status, 0);
    EXPECT_THAT(view(address, {"--tls-ca", second.authority()}).text, HasSubstr("not trusted by"));
  }
  const XvncServer server(options(second));
  const Output changed = view(address, {});
  EXPECT_EQ(changed.status, 1);
  EXPECT_THAT(changed.text, HasSubstr("HAS CHANGED"));
  EXPECT_EQ(view(address, {"--tls-fingerprint", second.fingerprint()}).status, 0);
  EXPECT_EQ(view(address, {}).status, 0);
}

TEST_F(ViewSecurityTest, RefusesWhatIsBelowTheRequiredLevel) {
  const XvncServer server({.size = {320, 240}});
  const Output refused = view(server.unixAddress(), {"--require", "tls"});
  EXPECT_EQ(refused.status, 1);
  EXPECT_THAT(refused.text, HasSubstr("below the level tls"));
  EXPECT_EQ(view(server.unixAddress(), {"--require", "strong"}).status, 2);
  EXPECT_EQ(view(server.unixAddress(), {"--tls-fingerprint", "12:34"}).status, 2);
}

// A program on a terminal of its own.
class OnTerminal {
 public:
  explicit OnTerminal(const std::vector<std::string>& command) {
    pid_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (pid_ != 0) return;
    std::vector<std::string> words = command;
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    ::execv(arguments.front(), arguments.data());
    ::_exit(127);
  }
  ~OnTerminal() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      ::waitpid(pid_, nullptr, 0);
    }
    ::close(terminal_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void type(const std::string& text) const {
    ASSERT_EQ(::write(terminal_, text.data(), text.size()), std::ssize(text));
  }
  // What it wrote until it wrote `words` or ended.
  std::string readUntil(const std::string& words) {
    std::string text;
    std::array<char, 512> part{};
    while (text.find(words) == std::string::npos) {
      pollfd watched{terminal_, POLLIN, 0};
      if (::poll(&watched, 1, 60'000) <= 0) break;
      const ssize_t got = ::read(terminal_, part.data(), part.size());
      if (got <= 0) break;
      text.append(part.data(), static_cast<std::size_t>(got));
    }
    return text;
  }
  int exitStatus() {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  int terminal_ = -1;
  pid_t pid_ = -1;
};

TEST_F(ViewSecurityTest, AsksOnTheTerminalWithoutAnEcho) {
  const XvncServer server({.size = {320, 240}, .password = "sesame"});
  OnTerminal viewer(command(server.unixAddress(), {}));
  EXPECT_THAT(viewer.readUntil("vnc.sock: "), HasSubstr("Password for unix:"));
  viewer.type("sesame\n");
  EXPECT_THAT(viewer.readUntil("the end of its output"), Not(HasSubstr("sesame")));
  EXPECT_EQ(viewer.exitStatus(), 0);
}

TEST_F(ViewSecurityTest, MayBeInterruptedAtThePrompt) {
  const XvncServer server({.size = {320, 240}, .password = "sesame"});
  OnTerminal viewer(command(server.unixAddress(), {}));
  EXPECT_THAT(viewer.readUntil("vnc.sock: "), HasSubstr("Password for unix:"));
  viewer.type("\x03");
  EXPECT_THAT(viewer.readUntil("the end of its output"), HasSubstr("asks for a password"));
  EXPECT_EQ(viewer.exitStatus(), 1);
}

}  // namespace
}  // namespace pixelflex::testing
