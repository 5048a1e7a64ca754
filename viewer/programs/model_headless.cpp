#include "viewer/programs/model_headless.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "devices/display/gl_context.h"
#include "devices/image/png_file.h"

namespace pixelflex::viewer {
namespace {

/// The mean of two neighbours in a row becomes a pixel.
void squeeze(const devices::Image8& from, devices::Image8& to, int left) {
  for (int y = 0; y < from.height(); ++y) {
    for (int x = 0; x < from.width() / 2; ++x) {
      for (int c = 0; c < 3; ++c) {
        to.at(left + x, y, c) = static_cast<std::uint8_t>((from.at(2 * x, y, c) + from.at(2 * x + 1, y, c) + 1) / 2);
      }
    }
  }
}

}  // namespace

devices::Image8 stereoPicture(const devices::Image8& left, const devices::Image8& right, StereoPicture kind) {
  devices::Image8 picture = right;
  if (kind == StereoPicture::kSideBySide) {
    squeeze(left, picture, 0);
    squeeze(right, picture, left.width() / 2);
  } else {
    for (int y = 0; y < left.height(); ++y) {
      for (int x = 0; x < left.width(); ++x) picture.at(x, y, 0) = left.at(x, y, 0);
    }
  }
  return picture;
}

void writeModelPictures(const std::filesystem::path& folder, ModelWall& model, StereoPicture stereo) {
  std::filesystem::create_directories(folder);
  for (std::size_t i = 0; i < model.projectorCount(); ++i) {
    devices::writePng(folder / (model.name(i) + ".png"), model.read(i));
  }
  const bool both = stereo != StereoPicture::kOff && model.desktopCount() >= 2;
  devices::writePng(folder / "desktop.png", both ? stereoPicture(model.readDesktop(0), model.readDesktop(1), stereo)
                                                 : model.readDesktop(model.desktopCount() - 1));
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
  options.bothEyes = command.stereo != StereoPicture::kOff;
  ModelWall model(context, wall, command.wall, options);
  const auto triangles = scene.triangles();
  model.setScene(std::move(scene));
  printFits(command, wall, model);
  ModelView view = viewOf(command, windowOf(wall.display()));
  const std::filesystem::path folder = *command.screenshot;
  for (int frame = 0; frame < std::max(command.turntable, 1); ++frame) {
    if (command.turntable > 0) view.pose.yaw = command.pose.yaw + 360.0 * frame / command.turntable;
    model.setView(view);
    model.draw();
    writeModelPictures(command.turntable > 0 ? folder / fmt::format("{:03}", frame) : folder, model, command.stereo);
  }
  fmt::print("{} triangles on {} projectors in {}\n", triangles, model.projectorCount(), *command.screenshot);
  return 0;
}

}  // namespace pixelflex::viewer
