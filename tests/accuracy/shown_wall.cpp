#include "tests/accuracy/shown_wall.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "devices/display/gl_context.h"
#include "tests/accuracy/report_light.h"
#include "tests/gl/plans.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::calib {
namespace {

using devices::Image8;
using devices::ImageF;

/// A renderer and its own context.
class Stand {
 public:
  Stand(const Rig& rig, const std::vector<viewer::OutputPlan>& plans, viewer::RendererOptions options)
      : renderer_(context_, options), count_(rig.projectors.size()) {
    renderer_.setPlans(plans);
    for (const auto& plan : plans) {
      const auto found = std::ranges::find(rig.projectors, plan.name, &SimulatedProjectorSpec::name);
      places_.push_back(static_cast<std::size_t>(found - rig.projectors.begin()));
    }
  }

  [[nodiscard]] viewer::WallRenderer& renderer() { return renderer_; }

  /// read(output) of each, in the rig's order.
  template <class Read>
  [[nodiscard]] std::vector<Image8> frames(const Read& read) {
    renderer_.draw();
    std::vector<Image8> frames(count_);
    for (std::size_t output = 0; output < places_.size(); ++output) frames.at(places_[output]) = read(output);
    return frames;
  }

 private:
  devices::HeadlessContext context_;
  viewer::WallRenderer renderer_;
  std::vector<std::size_t> places_;  // in the rig, of each output
  std::size_t count_;
};

Show showPlans(const Rig& rig, const std::vector<viewer::OutputPlan>& plans) {
  const auto stand = std::make_shared<Stand>(rig, plans, viewer::RendererOptions{});
  return [stand](const Image8& desktop) {
    stand->renderer().upload(testing::wholeBatch(desktop));
    return stand->frames([&](std::size_t output) { return stand->renderer().readOutput(output); });
  };
}

}  // namespace

Show showMatched(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop) {
  return showPlans(rig, plan.outputsFor(desktop));
}

Show showUncorrected(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop) {
  auto plans = plan.outputsFor(desktop);
  for (auto& output : plans) {
    output.colour = glm::mat3(1);
    output.alpha = output.gain = output.black = {};
    output.inverseResponse = {};
  }
  return showPlans(rig, plans);
}

Show showAsInReport(const Rig& rig, const viewer::WallPlan& plan, devices::Size desktop,
                    const std::filesystem::path& folder) {
  auto plans = plan.outputsFor(desktop);
  for (auto& output : plans) {
    output.filter = viewer::Filter::kBilinear;
    output.filterDomain = viewer::FilterDomain::kSrgb;  // of the values as they are, which are light already
  }
  const auto stand = std::make_shared<Stand>(rig, plans, viewer::RendererOptions{.measure = true});
  const auto light = std::make_shared<std::vector<ReportLight>>(reportLight(plan, folder));
  return [stand, light](const Image8& desktop8) {
    stand->renderer().uploadDesktop(reportDesktop(desktop8));
    return stand->frames(
        [&](std::size_t output) { return reportFrame(stand->renderer().readOutputFloat(output), light->at(output)); });
  };
}

}  // namespace pixelflex::calib
