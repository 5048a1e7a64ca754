#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <string>
#include <system_error>

#include "devices/image/atomic_file.h"
#include "tests/support/temporary_folder.h"

namespace pixelflex::testing {
namespace {

using devices::writeFileAtomically;

std::string readAll(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::size_t filesIn(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator files(folder);
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

TEST(ImageAtomic, MakesFoldersAndReplacesTheFile) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "a" / "b" / "file";
  writeFileAtomically(path, "first");
  EXPECT_EQ(readAll(path), "first");
  writeFileAtomically(path, std::string(1 << 20, 'x'));
  EXPECT_EQ(readAll(path), std::string(1 << 20, 'x'));
  writeFileAtomically(path, "");
  EXPECT_EQ(readAll(path), "");
  EXPECT_EQ(filesIn(path.parent_path()), 1U);
}

TEST(ImageAtomic, OthersMayReadTheFile) {
  const TemporaryFolder folder;
  writeFileAtomically(folder.path() / "file", "x");
  struct stat status {};
  ASSERT_EQ(::stat((folder.path() / "file").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0644U);
}

TEST(ImageAtomic, AFailureNamesTheFileAndLeavesNothingBehind) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "target";
  std::filesystem::create_directories(path / "inside");
  try {
    writeFileAtomically(path, "text");
    FAIL() << "a folder cannot be replaced by a file";
  } catch (const std::system_error& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr(path.string()));
  }
  EXPECT_EQ(filesIn(folder.path()), 1U);
  EXPECT_THROW(writeFileAtomically("/proc/nowhere/file", "text"), std::system_error);
}

TEST(ImageAtomic, AKilledWriterLeavesTheOldFileOrTheNewOne) {
  constexpr std::size_t kLength = std::size_t{1} << 20;
  const TemporaryFolder folder;
  const auto path = folder.path() / "file";
  writeFileAtomically(path, std::string(kLength, 'a'));
  std::mt19937 random(3);
  for (int round = 0; round < 30; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    while (child == 0) {
      for (char letter = 'a'; letter <= 'z'; ++letter) writeFileAtomically(path, std::string(kLength, letter));
    }
    ::usleep(std::uniform_int_distribution<unsigned>(1'000, 20'000)(random));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const std::string text = readAll(path);
    ASSERT_EQ(text.size(), kLength);
    ASSERT_TRUE(std::ranges::all_of(text, [&](char c) { return c == text.front(); }));
  }
}

}  // namespace
}  // namespace pixelflex::testing
