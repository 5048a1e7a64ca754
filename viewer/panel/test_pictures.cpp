#include "viewer/panel/test_pictures.h"

#include <algorithm>
#include <exception>
#include <utility>

#include "viewer/control/child_program.h"

namespace pixelflex::viewer {

void TestPictures::show(PanelContext& panel, const std::vector<std::string>& projectors, const std::string& picture) {
  std::erase_if(ending_, [](const Shown& shown) { return shown.ended->load(); });
  std::string names;
  for (const auto& projector : projectors) names += (names.empty() ? "" : ",") + projector;
  panel.console.log(LogLine::Kind::kCommand, "pixelflex panel " + panel.console.folder().string() + " --show " +
                                                 picture + " --projectors " + names);
  for (const auto& config : panel.wall->wall->projectors) {
    if (std::ranges::find(projectors, config.name) != projectors.end()) showOne(panel, config, picture);
  }
}

void TestPictures::end(const std::string& projector) {
  auto shown = shown_.extract(projector);
  if (shown.empty() || !shown.mapped().thread.joinable()) return;
  shown.mapped().thread.request_stop();
  ending_.push_back(std::move(shown.mapped()));
}

void TestPictures::showOne(PanelContext& panel, const calib::ProjectorConfig& projector, const std::string& picture) {
  end(projector.name);
  // With another camera the room is served by another program, which looks at what --show puts there.
  const bool simulated = projector.output.kind == calib::OutputKind::kSim && panel.wall->wall->camera.source == "sim";
  if (simulated) inRoom_(projector.name, drawTestPicture(picture, projector.name, projector.resolution));
  if (projector.output.kind == calib::OutputKind::kNone) {
    panel.console.log(LogLine::Kind::kNote, projector.name + ": wall.yaml gives it no output, so nothing can be shown");
    return;
  }
  if (picture == "off") return;
  Shown& shown = shown_[projector.name];
  shown.picture = picture;
  if (!simulated) startProgram(panel, shown, projector.name);
}

void TestPictures::startProgram(PanelContext& panel, Shown& shown, const std::string& projector) {
  const std::vector<std::string> arguments = {
      panel.console.folder().string(), "--show", shown.picture, "--projectors", projector, "--until-eof"};
  shown.thread = std::jthread([&console = panel.console, program = programs_ / "pixelflex-panel", arguments,
                               ended = shown.ended](const std::stop_token& stop) {
    try {
      const auto line = [&](const std::string& text, bool isError) {
        if (isError) console.log(LogLine::Kind::kError, text);
      };
      (void)runChildProgram(program, arguments, stop, line, ChildInput::kOurLife);
    } catch (const std::exception& error) {
      console.log(LogLine::Kind::kError, error.what());
    }
    *ended = true;
  });
}

std::string TestPictures::shownOn(const std::string& projector) const {
  const auto shown = shown_.find(projector);
  return shown == shown_.end() || *shown->second.ended ? "off" : shown->second.picture;
}

std::string TestPictures::whereIs(const PanelContext& panel, const std::string& projector) const {
  const auto& projectors = panel.wall->wall->projectors;
  const auto config = std::ranges::find(projectors, projector, &calib::ProjectorConfig::name);
  switch (config->output.kind) {
    case calib::OutputKind::kMonitor:
      return "on monitor " + config->output.monitor;
    case calib::OutputKind::kDisplay:
      return "on display " + config->output.display;
    case calib::OutputKind::kSim:
      return "in the simulated room";
    default:
      return "no output in wall.yaml";
  }
}

}  // namespace pixelflex::viewer
