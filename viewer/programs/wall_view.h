#pragma once

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/plan/pointer_map.h"
#include "viewer/plan/wall_plan.h"
#include "viewer/programs/desk_texts.h"
#include "viewer/programs/lost_picture.h"
#include "viewer/programs/view_options.h"
#include "viewer/programs/wall_reloader.h"
#include "viewer/renderer/wall_renderer.h"
#include "viewer/tiles/frame_belt.h"
#include "viewer/tiles/stage_stats.h"
#include "viewer/vnc/desktop_source.h"

namespace pixelflex::viewer {

/// The session ended for good; what() is the reason for people.
class ViewError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// It ended because a password that was not given is needed.
class PasswordNeeded : public ViewError {
 public:
  using ViewError::ViewError;
};

/// The plans for a wall's own desktop, made in the background meanwhile; `wall` must outlive it.
using ExpectedPlans = std::future<std::vector<OutputPlan>>;
[[nodiscard]] ExpectedPlans expectPlans(const WallPlan& wall);

/// A server's desktop on a wall: source, belt and renderer held together on the render thread, which calls step()
/// whenever it is woken.
class WallView {
 public:
  using Clock = std::chrono::steady_clock;

  /// `wake` is called from any thread when there is something to do; all references must outlive this.
  WallView(const ViewOptions& options, const WallPlan& wall, ExpectedPlans expected, devices::GlContext& context,
           const std::function<void()>& wake);

  struct Step {
    std::vector<std::size_t> drawn;  // outputs whose frame changed
    bool cursorChanged = false;
    bool plansChanged = false;  // textures and sizes of all outputs are new
    bool bell = false;
    std::vector<Clipboard> copied;  // texts that others here may paste
  };
  /// Takes what has arrived and draws what it touched. Throws ViewError when the session has ended.
  Step step();
  /// What step() has drawn is on its windows now.
  void shown() { stages_.shown(Clock::now()); }

  /// At least one whole update has been drawn, and the server is there.
  [[nodiscard]] bool hasPicture() const { return hasPicture_ && !lostSince_; }
  [[nodiscard]] Clock::time_point lastChange() const { return lastChange_; }
  [[nodiscard]] std::uint64_t updates() const { return updates_; }
  /// Times of the updates that were shown.
  [[nodiscard]] const StageStats& stages() const { return stages_; }
  [[nodiscard]] const std::string& desktopName() const { return desktopName_; }
  [[nodiscard]] devices::Size desktop() const { return desktop_; }

  [[nodiscard]] WallRenderer& renderer() { return renderer_; }
  /// As measured at the start.
  [[nodiscard]] const std::vector<UploadRate>& uploads() const { return uploads_; }
  /// The one that is shown: the one given, or what a new calibration has put in its place, with the same projectors.
  [[nodiscard]] const WallPlan& wall() const { return reloaded_ ? *reloaded_ : wall_; }
  /// Null before the first connection.
  [[nodiscard]] const PointerMap* pointerMap() const { return pointerMap_ ? &*pointerMap_ : nullptr; }

  /// The desktop pixel that it points at, whoever moved it.
  [[nodiscard]] glm::ivec2 pointer() const { return pointer_; }
  /// Draws a ring around it for a second.
  void findPointer();
  /// When step() has something to do although nothing arrives.
  [[nodiscard]] Clock::time_point due() const;
  /// The output that shows the whole desktop, see ViewOptions::control: after those of the projectors.
  [[nodiscard]] std::size_t controlOutput() const { return wall().projectors().size(); }

  /// Moves the pointer there, locally at once, and tells the server.
  void point(glm::ivec2 pointInDesktop, std::uint16_t buttons);
  void key(std::uint32_t keysym, bool down) { source_->sendKey(keysym, down); }
  /// Text was copied on this side. A desktop that comes (back) gets the last one, too. Any thread.
  void copy(Selection selection, std::string text);
  /// Says once for each side that a text was too long. Any thread.
  void refuse(const ClipboardRefused& refused);
  void markAll() { renderer_.markAll(); }

 private:
  void handle(const SessionEvent& event);
  void lose(const std::string& reason);
  /// From here on the VNC server that was asked for is the source.
  void goByVnc(Retry retry);
  void comeBack();
  [[nodiscard]] std::unique_ptr<DesktopSource> openSource();
  void adopt(devices::Size desktop);
  void show(std::vector<OutputPlan> plans);
  void adoptNewWall();
  void requestLayout();

  const ViewOptions& options_;
  const WallPlan& wall_;
  std::shared_ptr<const WallPlan> reloaded_;
  ExpectedPlans expected_;  // until the first desktop
  std::vector<UploadRate> uploads_;
  WallRenderer renderer_;
  LostPicture picture_;
  FrameBelt belt_;
  std::function<void()> wake_;
  bool local_ = false;   // straight from an X server
  bool direct_ = false;  // the X server behind the VNC server that was asked for
  std::unique_ptr<DesktopSource> source_;
  WallReloader reloader_;
  std::optional<PointerMap> pointerMap_;
  devices::Size desktop_;
  std::string desktopName_;
  glm::ivec2 pointer_{0, 0};
  Clock::time_point fadeDue_;  // of the borders around damage
  Clock::time_point ringUntil_ = Clock::time_point::max();
  DeskTexts texts_;
  bool bell_ = false;
  bool hasPicture_ = false;
  std::optional<Clock::time_point> lostSince_;
  bool connected_ = false;
  bool plansChanged_ = false;
  bool updateOpen_ = false;  // half of one is uploaded
  std::uint64_t updates_ = 0;
  StageStats stages_;
  Clock::time_point lastChange_ = Clock::now();
};

}  // namespace pixelflex::viewer
