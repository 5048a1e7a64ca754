#include "viewer/programs/model_headless.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "devices/display/gl_context.h"
#include "devices/image/png_file.h"
#include "viewer/programs/model_outputs.h"
#include "viewer/programs/model_room.h"

namespace pixelflex::viewer {
namespace {

constexpr int kRoomWidth = 1600;  // pixels

}  // namespace

void writeModelPictures(const std::filesystem::path& folder, ModelWall& model, StereoPicture* stereo) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < model.projectorCount(); ++i) {
    devices::writePng(folder / (model.name(i) + ".png"), model.read(i));
  }
  devices::writePng(folder / "desktop.png",
                    stereo != nullptr ? stereo->read() : model.readDesktop(model.desktopCount() - 1));
}

void printFits(const ModelCommand& command, const WallPlan& wall, const ModelWall& model) {
  const OnePassFit* worst = nullptr;
  std::string name;
  for (std::size_t i = 0; i < model.fits().size(); ++i) {
    const auto& fit = model.fits()[i];
    fmt::print("{}: one pass is within {:.2f} px rms, {:.2f} px at most, of the calibrated lens\n",
               wall.projectors()[i]->name, fit.rms, fit.maximum);
    if (worst != nullptr && worst->maximum >= fit.maximum) continue;
    worst = &fit;
    name = wall.projectors()[i]->name;
  }
  if (command.draw.passes == 2 || command.draw.lensAtVertices || worst == nullptr) return;
  if (worst->maximum <= kLargestOnePassError) return;
  fmt::print(
      stderr,
      "pixelflex-model: one pass is off by up to {:.2f} px ({}), which shows at seams: --passes 2 draws as exactly "
      "as a desktop is shown, --lens vertex does for a model of small triangles\n",
      worst->maximum, name);
}

int runModelHeadless(const ModelCommand& command, const WallPlan& wall, Scene scene) {
  devices::HeadlessContext context;
  auto options = command.draw;
  options.desktop = true;
  options.bothEyes = command.stereo != StereoKind::kOff;
  ModelWall model(context, wall, options);
  const auto triangles = scene.triangles();
  model.setScene(std::move(scene));
  printFits(command, wall, model);
  std::optional<StereoPicture> stereo;
  if (options.bothEyes) stereo.emplace(context, wall.desktop());
  std::optional<ModelRoom> room;
  if (command.room) room.emplace(context, wall, command.wall, roomOf(command, wall));
  ModelView view = viewOf(command, windowOf(wall.display()));
  const std::filesystem::path folder = *command.screenshot;
  for (int frame = 0; frame < std::max(command.turntable, 1); ++frame) {
    if (command.turntable > 0) view.pose.yaw = command.pose.yaw + 360.0 * frame / command.turntable;
    model.setView(view);
    model.draw();
    if (stereo) stereo->draw(model.desktopTexture(0), model.desktopTexture(1), command.stereo);
    const auto into = command.turntable > 0 ? folder / fmt::format("{:03}", frame) : folder;
    writeModelPictures(into, model, stereo ? &*stereo : nullptr);
    if (!room) continue;
    room->draw(model, room->sizeFor(kRoomWidth));
    devices::writePng(into / "room.png", room->read());
  }
  fmt::print("{} triangles on {} projectors in {}\n", triangles, model.projectorCount(), *command.screenshot);
  return 0;
}

}  // namespace pixelflex::viewer
