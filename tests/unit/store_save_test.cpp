#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <random>
#include <string>

#include "calib/store/store.h"
#include "calib/store/yaml_reader.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/store_values.h"

namespace pixelflex::testing {
namespace {

using calib::loadCalibration;
using calib::loadWall;
using calib::saveCalibration;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string messageOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const calib::StoreError& error) {
    return error.what();
  }
  return "";
}

TEST(StoreSave, WhatIsSavedLoadsAgain) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "deep" / "wall";
  calib::saveWall(path, flatWall(2, 2));
  EXPECT_FALSE(calib::hasCalibration(path));
  saveCalibration(path, flatCalibration(flatWall(2, 2)));
  EXPECT_TRUE(calib::hasCalibration(path));
  EXPECT_EQ(loadWall(path), flatWall(2, 2));
  EXPECT_EQ(loadCalibration(path), flatCalibration(flatWall(2, 2)));
}

TEST(StoreSave, MissingFilesSayWhatToDo) {
  const TemporaryFolder folder;
  const std::string path = folder.path().string();
  EXPECT_EQ(messageOf([&] { (void)loadCalibration(path); }),
            path + "/calibration.yaml: the wall is not calibrated yet: run pixelflex calibrate " + path);
  EXPECT_EQ(messageOf([&] { (void)loadWall(path); }),
            path + "/wall.yaml: there is no such file; make the wall's folder with: pixelflex new " + path);
}

TEST(StoreSave, AFolderOrAnUnreadableFileIsRefused) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "wall.yaml");
  EXPECT_THAT(messageOf([&] { (void)loadWall(folder.path()); }), HasSubstr("this is a folder, not a file"));
  EXPECT_THAT(messageOf([&] { (void)calib::readStoreFile((folder.path() / "none").string()); }),
              HasSubstr("No such file or directory"));
}

TEST(StoreSave, AFileBeyondTheBoundIsRefused) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "wall.yaml";
  std::ofstream(path) << "a";
  std::filesystem::resize_file(path, (std::uintmax_t{64} << 20) + 70'000);
  EXPECT_THAT(messageOf([&] { (void)loadWall(folder.path()); }), HasSubstr("larger than 64 MiB"));
}

TEST(StoreSave, AnInvalidValueNeverReplacesAGoodFile) {
  const TemporaryFolder folder;
  const auto good = flatCalibration(flatWall(1, 1));
  saveCalibration(folder.path(), good);
  auto bad = good;
  bad.projectors[0].samples[0].pointInWall.x = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(messageOf([&] { saveCalibration(folder.path(), bad); }), HasSubstr("found \"nan\""));
  EXPECT_EQ(loadCalibration(folder.path()), good);
}

TEST(StoreSave, AFolderThatCannotBeMadeIsNamed) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  EXPECT_THAT(messageOf([&] { calib::saveWall(folder.path() / "file" / "wall", flatWall(1, 1)); }),
              HasSubstr((folder.path() / "file").string()));
}

/// Saves one of two calibrations for ever, each with many samples so that the writing takes its time.
[[noreturn]] void saveForEver(const std::filesystem::path& folder, calib::Calibration calibration) {
  for (int i = 0;; ++i) {
    calibration.steps["turn"] = std::to_string(i);
    for (auto& sample : calibration.projectors[0].samples) sample.pointInWall.x = i;
    saveCalibration(folder, calibration);
  }
}

TEST(StoreSave, AKilledProgramLeavesAWholeFile) {
  const TemporaryFolder folder;
  calib::Calibration calibration = flatCalibration(flatWall(1, 1));
  calibration.steps["turn"] = "0";
  calibration.projectors[0].samples.assign(4000, {});
  saveCalibration(folder.path(), calibration);
  std::mt19937 random(7);
  for (int round = 0; round < 25; ++round) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) saveForEver(folder.path(), calibration);
    ::usleep(std::uniform_int_distribution<unsigned>(2'000, 40'000)(random));
    ::kill(child, SIGKILL);
    ASSERT_EQ(::waitpid(child, nullptr, 0), child);
    const auto loaded = loadCalibration(folder.path());
    const double turn = std::stod(loaded.steps.at("turn"));
    ASSERT_EQ(loaded.projectors[0].samples.size(), 4000U);
    for (const auto& sample : loaded.projectors[0].samples) ASSERT_EQ(sample.pointInWall.x, turn);
  }
}

}  // namespace
}  // namespace pixelflex::testing
