#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "devices/display/gl_context.h"

namespace pixelflex::testing {

/// A context without a window, about whose use the driver must have had nothing to complain.
template <class Base = ::testing::Test>
class GlTest : public Base {
 protected:
  void TearDown() override {
    context_.makeCurrent();
    EXPECT_EQ(log_.take(), std::vector<std::string>{});
  }

  devices::HeadlessContext context_;
  devices::GlDebugLog log_;
};

}  // namespace pixelflex::testing
