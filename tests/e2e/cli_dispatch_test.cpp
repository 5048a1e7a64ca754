#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/process.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kBin = PIXELFLEX_BIN_DIR;

/// The dispatcher alone in a folder with the programs that a test puts beside it.
class CliDispatch : public ::testing::Test {
 protected:
  CliDispatch() { fs::copy_file(kBin + "/pixelflex", folder_ / "pixelflex"); }

  void addProgram(const std::string& name, const std::string& script) const {
    std::ofstream(folder_ / ("pixelflex-" + name)) << "#!/bin/sh\n" << script << "\n";
    fs::permissions(folder_ / ("pixelflex-" + name), fs::perms::owner_all);
  }
  [[nodiscard]] Output pixelflex(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), (folder_ / "pixelflex").string());
    return run(arguments);
  }
  TemporaryFolder folder_;
};

TEST_F(CliDispatch, RunsTheProgramBesideItWithItsArgumentsAndStatus) {
  addProgram("view", R"(for a in "$@"; do echo "<$a>"; done; exit 7)");
  const Output output = pixelflex({"view", "a b", "", "--x=$y"});
  EXPECT_EQ(output.status, 7);
  EXPECT_EQ(output.text, "<a b>\n<>\n<--x=$y>\n");
}

TEST_F(CliDispatch, FollowsSymbolicLinksToItsOwnFolder) {
  addProgram("view", "echo found");
  const TemporaryFolder elsewhere;
  fs::create_symlink(folder_ / "pixelflex", elsewhere / "pf");
  EXPECT_EQ(run({(elsewhere / "pf").string(), "view"}).text, "found\n");
}

TEST_F(CliDispatch, HelpListsOnlyWhatIsThere) {
  addProgram("view", "true");
  const Output output = pixelflex({"help"});
  EXPECT_EQ(output.status, 0);
  EXPECT_THAT(output.text, HasSubstr("  view       shows a VNC desktop on the wall\n"));
  EXPECT_THAT(output.text, Not(HasSubstr("calibrate")));
  EXPECT_EQ(pixelflex({"--help"}).text, output.text);
}

TEST_F(CliDispatch, HelpOfACommandAsksThatCommand) {
  addProgram("view", "echo \"help: $*\"");
  EXPECT_EQ(pixelflex({"help", "view"}).text, "help: --help\n");
}

TEST_F(CliDispatch, SaysItsVersion) {
  const Output output = pixelflex({"--version"});
  EXPECT_EQ(output.status, 0);
  EXPECT_THAT(output.text, ::testing::MatchesRegex("pixelflex [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CliDispatch, SuggestsTheNearestCommand) {
  addProgram("check", "true");
  const Output output = pixelflex({"chek"});
  EXPECT_EQ(output.status, 2);
  EXPECT_EQ(output.text,
            "pixelflex: there is no command \"chek\"; did you mean \"check\"? (pixelflex help lists the commands)\n");
}

TEST_F(CliDispatch, WrongUsageIsStatusTwo) {
  addProgram("view", "true");
  for (const std::string name : {"", "nothing", "../pixelflex", "./view", "VIEW", "-x", "--nope"}) {
    EXPECT_EQ(pixelflex({name}).status, 2) << name;
  }
  EXPECT_EQ(pixelflex({}).status, 2);
  EXPECT_EQ(pixelflex({"help", "nothing"}).status, 2);
}

TEST_F(CliDispatch, SaysWhyAProgramCannotRun) {
  addProgram("view", "true");
  std::ofstream(folder_ / "pixelflex-view") << "#!/no/such/interpreter\n";
  const Output output = pixelflex({"view"});
  EXPECT_EQ(output.status, 1);
  EXPECT_THAT(output.text, HasSubstr("pixelflex: cannot run "));
}

}  // namespace
}  // namespace pixelflex::testing
