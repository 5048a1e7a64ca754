#pragma once

#include <memory>
#include <string>
#include <vector>

#include "devices/display/display_error.h"

namespace pixelflex::devices {

/// A place where GL 4.5 core commands go. One thread at a time may have it current.
class GlContext {
 public:
  GlContext() = default;
  virtual ~GlContext() = default;
  GlContext(const GlContext&) = delete;
  GlContext& operator=(const GlContext&) = delete;

  /// Makes this the calling thread's context. Throws DisplayError when the context is lost or current elsewhere.
  virtual void makeCurrent() = 0;
};

/// What the driver complained about in one context: GL errors and anything of high severity, oldest first, at most
/// kMaxMessages of them. Must outlive the context's last command, or be destroyed with that context current.
class GlDebugLog {
 public:
  static constexpr std::size_t kMaxMessages = 100;

  /// Starts listening to the current context.
  GlDebugLog();
  ~GlDebugLog();
  GlDebugLog(const GlDebugLog&) = delete;
  GlDebugLog& operator=(const GlDebugLog&) = delete;

  /// Messages since the last call.
  [[nodiscard]] std::vector<std::string> take();
  /// Throws DisplayError with every message since the last call, if there is any.
  void throwIfAny();

 private:
  std::vector<std::string> messages_;
};

/// GL without window, screen or X server: a surfaceless EGL context. Draw into framebuffer objects only.
class HeadlessContext final : public GlContext {
 public:
  /// Made current. Throws DisplayError when EGL, surfaceless contexts or OpenGL 4.5 are missing.
  HeadlessContext();
  ~HeadlessContext() override;
  HeadlessContext(const HeadlessContext&) = delete;
  HeadlessContext& operator=(const HeadlessContext&) = delete;

  void makeCurrent() override;

 private:
  struct Egl;
  std::unique_ptr<Egl> egl_;
};

}  // namespace pixelflex::devices
