// The one owner of GL names, with names that count instead of a driver.
#include <gtest/gtest.h>

#include <type_traits>
#include <vector>

#include "devices/display/gl_handle.h"

namespace pixelflex::devices {
namespace {

struct CountingKind {
  static inline GlName next = 1;
  static inline std::vector<GlName> destroyed;
  static GlName create(GlName step = 1) { return next += step; }
  static void destroy(GlName name) { destroyed.push_back(name); }
};
using Handle = GlHandle<CountingKind>;

class GlHandleTest : public ::testing::Test {
 protected:
  void SetUp() override { CountingKind::destroyed.clear(); }
  static std::vector<GlName> destroyed() { return CountingKind::destroyed; }
};

TEST_F(GlHandleTest, MovesOnly) {
  static_assert(!std::is_copy_constructible_v<Handle>);
  static_assert(!std::is_copy_assignable_v<Handle>);
  static_assert(std::is_nothrow_move_constructible_v<Handle>);
  static_assert(std::is_nothrow_move_assignable_v<Handle>);
}

TEST_F(GlHandleTest, DestroysWhatItCreatedOnce) {
  GlName name = 0;
  {
    const auto handle = Handle::create();
    name = handle.get();
    EXPECT_TRUE(handle);
  }
  EXPECT_EQ(destroyed(), std::vector<GlName>{name});
}

TEST_F(GlHandleTest, PassesArgumentsToItsKind) {
  const auto before = CountingKind::next;
  EXPECT_EQ(Handle::create(GlName{10}).get(), before + 10);
}

TEST_F(GlHandleTest, EmptyDestroysNothing) {
  { const Handle handle; }
  EXPECT_TRUE(destroyed().empty());
}

TEST_F(GlHandleTest, MoveLeavesTheSourceEmpty) {
  {
    auto from = Handle::adopt(70);
    const Handle to(std::move(from));
    EXPECT_EQ(to.get(), 70U);
    EXPECT_FALSE(from);  // NOLINT(bugprone-use-after-move): what a moved handle is, is the question
  }
  EXPECT_EQ(destroyed(), std::vector<GlName>{70});
}

TEST_F(GlHandleTest, MoveAssignmentDeletesTheLiveObjectOnce) {
  {
    auto to = Handle::adopt(71);
    to = Handle::adopt(72);
    EXPECT_EQ(destroyed(), std::vector<GlName>{71});
    EXPECT_EQ(to.get(), 72U);
  }
  EXPECT_EQ(destroyed(), (std::vector<GlName>{71, 72}));
}

TEST_F(GlHandleTest, AssignmentToItselfKeepsTheObject) {
  auto handle = Handle::adopt(73);
  auto& same = handle;
  handle = std::move(same);
  EXPECT_EQ(handle.get(), 73U);
  EXPECT_TRUE(destroyed().empty());
}

TEST_F(GlHandleTest, ReleaseGivesTheNameAway) {
  {
    auto handle = Handle::adopt(74);
    EXPECT_EQ(handle.release(), 74U);
  }
  EXPECT_TRUE(destroyed().empty());
}

}  // namespace
}  // namespace pixelflex::devices
