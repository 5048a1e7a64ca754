#include <epoxy/gl.h>

#include <utility>

#include "devices/display/gl_context.h"

namespace pixelflex::devices {
namespace {

void note(GLenum /*source*/, GLenum type, GLuint /*id*/, GLenum severity, GLsizei length, const GLchar* text,
          const void* log) {
  const bool glError = type == GL_DEBUG_TYPE_ERROR && severity != GL_DEBUG_SEVERITY_LOW;
  if (!glError && severity != GL_DEBUG_SEVERITY_HIGH) return;
  // GL hands the pointer back as const although it was given as the owner's own.
  auto* messages = static_cast<std::vector<std::string>*>(const_cast<void*>(log));  // NOLINT(*-const-cast)
  if (messages->size() >= GlDebugLog::kMaxMessages) return;
  messages->emplace_back(text, static_cast<std::size_t>(length));
}

}  // namespace

GlDebugLog::GlDebugLog() {
  glEnable(GL_DEBUG_OUTPUT);
  glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
  glDebugMessageCallback(note, &messages_);
}

GlDebugLog::~GlDebugLog() {
  glDebugMessageCallback(nullptr, nullptr);
}

std::vector<std::string> GlDebugLog::take() {
  return std::exchange(messages_, {});
}

void GlDebugLog::throwIfAny() {
  const auto messages = take();
  if (messages.empty()) return;
  std::string all;
  for (const auto& message : messages) all += "\n  " + message;
  throw DisplayError("the graphics driver reported errors:" + all);
}

}  // namespace pixelflex::devices
