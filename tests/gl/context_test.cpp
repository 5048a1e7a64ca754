// The headless context, its error log and the shader compiler's messages.
#include <epoxy/gl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>

#include "devices/display/gl_context.h"
#include "devices/display/gl_program.h"

namespace pixelflex::devices {
namespace {

using ::testing::HasSubstr;

constexpr const char* kVertex = "void main() { gl_Position = vec4(0.0); }\n";
constexpr const char* kFragment = "layout(location = 0) out vec4 c; void main() { c = vec4(1.0); }\n";

TEST(HeadlessContextTest, NeedsNoXServer) {
  ASSERT_EQ(unsetenv("DISPLAY"), 0);
  ASSERT_EQ(unsetenv("WAYLAND_DISPLAY"), 0);
  const HeadlessContext context;
  GLint major = 0;
  GLint minor = 0;
  glGetIntegerv(GL_MAJOR_VERSION, &major);
  glGetIntegerv(GL_MINOR_VERSION, &minor);
  EXPECT_GE(10 * major + minor, 45);
}

TEST(HeadlessContextTest, ContextsAreIndependent) {
  HeadlessContext first;
  const auto name = GlTexture::create(GL_TEXTURE_2D).release();
  HeadlessContext second;
  EXPECT_EQ(glIsTexture(name), GL_FALSE);
  first.makeCurrent();
  EXPECT_EQ(glIsTexture(name), GL_TRUE);
  glDeleteTextures(1, &name);
}

[[noreturn]] void openWithoutDrivers() {
  setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nonexistent.json", 1);  // as if no driver were installed
  try {
    const HeadlessContext context;
  } catch (const DisplayError& error) {
    std::fputs(error.what(), stderr);
    std::_Exit(7);
  }
  std::_Exit(0);
}

TEST(HeadlessContextDeathTest, SaysWhatToInstallWhenEglIsMissing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(openWithoutDrivers(), ::testing::ExitedWithCode(7), "no headless graphics.*install Mesa's EGL");
}

TEST(GlDebugLogTest, HoldsGlErrors) {
  const HeadlessContext context;
  GlDebugLog log;
  EXPECT_TRUE(log.take().empty());
  EXPECT_NO_THROW(log.throwIfAny());
  glEnable(0x1234);
  glBindTextureUnit(0, 4242);
  EXPECT_EQ(log.take().size(), 2U);
  EXPECT_TRUE(log.take().empty());
  glEnable(0x1234);
  EXPECT_THROW(log.throwIfAny(), DisplayError);
}

TEST(GlProgramTest, LinksSoundShaders) {
  const HeadlessContext context;
  GlDebugLog log;
  const GlProgram program("plain", {kVertex}, {kFragment});
  program.use();
  EXPECT_TRUE(log.take().empty());
}

TEST(GlProgramTest, SaysWhatDoesNotCompile) {
  const HeadlessContext context;
  try {
    const GlProgram program("broken", {kVertex}, {"void main() { nonsense(); }\n"});
    FAIL() << "compiled";
  } catch (const DisplayError& error) {
    EXPECT_THAT(error.what(), HasSubstr("fragment shader of 'broken'"));
    EXPECT_THAT(error.what(), HasSubstr("nonsense"));
  }
}

TEST(GlProgramTest, SaysWhatDoesNotLink) {
  const HeadlessContext context;
  try {
    const GlProgram program(
        "loose", {kVertex},
        {"in vec3 missing;\n", "layout(location = 0) out vec4 c;\n", "void main() { c = vec4(missing, 1.0); }\n"});
    FAIL() << "linked";
  } catch (const DisplayError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'loose' do not link"));
    EXPECT_THAT(error.what(), HasSubstr("missing"));
  }
}

}  // namespace
}  // namespace pixelflex::devices
