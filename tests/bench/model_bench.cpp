// A model of many triangles on eight projectors, in one pass, beside plain drawing of the same pixels. See README.md.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"
#include "viewer/model/model_renderer.h"
#include "viewer/model/triangle_soup.h"

namespace {

using namespace pixelflex;
using Clock = std::chrono::steady_clock;

constexpr devices::Size kFrame{1024, 768};

double secondsSince(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

/// A bumpy ball, wider than high, so that it lies on all projectors.
viewer::Scene ball(std::size_t triangles) {
  const int rows = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(triangles) / 4)));
  const auto place = [rows](int row, int column) {
    const double a = M_PI * row / rows;
    const double b = M_PI * column / rows;
    const double r = 1 + 0.03 * std::sin(40 * a) * std::sin(40 * b);
    return glm::vec3(2 * r * std::sin(a) * std::cos(b), r * std::cos(a), r * std::sin(a) * std::sin(b));
  };
  viewer::TriangleSoup soup;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < 2 * rows; ++column) {
      const glm::vec3 corners[] = {place(row, column), place(row + 1, column), place(row + 1, column + 1),
                                   place(row, column + 1)};
      for (const int i : {0, 1, 2, 0, 2, 3}) soup.push_back({.position = corners[i], .normal = glm::vec3(0, 0, 1)});
    }
  }
  computeNormals(soup);
  viewer::Scene scene;
  scene.materials.emplace_back();
  addToScene(soup, 0, scene);
  return scene;
}

/// Four by two frames that overlap a little; with keystones and masks, or plain cuts of the desktop.
std::vector<viewer::ModelOutput> frames(bool keystone, bool mask) {
  std::vector<viewer::ModelOutput> outputs;
  for (int i = 0; i < 8; ++i) {
    viewer::ModelOutput output{.light = {.name = fmt::format("p{}", i + 1), .resolution = kFrame}};
    if (mask) {
      output.light.alpha = devices::Image16(kFrame, 1);
      std::ranges::fill(output.light.alpha.samples(), std::uint16_t{60000});
    }
    const double bend = keystone ? 0.03 * (i % 3 - 1) : 0;
    const double x = -3 + 2.0 * (i % 4);
    const double y = i < 4 ? -1 : 1;
    const glm::dmat3 h({3.7, 0, bend}, {0, 1.9, -bend}, {-x * 0.95, -y * 0.95, 1});
    output.projectorFromDesktop = viewer::depthKeeping(h);
    outputs.push_back(std::move(output));
  }
  return outputs;
}

/// Of all threads of the process.
double cpuSeconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double median(std::vector<double> values) {
  std::ranges::sort(values);
  return values[values.size() / 2];
}

/// One way of drawing and what it took.
struct Way {
  const char* name;
  std::unique_ptr<viewer::ModelRenderer> renderer;
  std::vector<double> seconds;
  std::vector<double> cpu;

  void draw(viewer::ModelView view, int round) {
    view.pose.yaw = 20 + 5.0 * round;
    renderer->setView(view);
    const auto begin = Clock::now();
    const double cpuBegin = cpuSeconds();
    renderer->draw();
    if (round < 0) return;  // the first compiles shaders
    seconds.push_back(secondsSince(begin));
    cpu.push_back(cpuSeconds() - cpuBegin);
  }
  void print(std::size_t triangles) const {
    std::size_t sent = 0;
    for (std::size_t i = 0; i < renderer->outputCount(); ++i) sent += renderer->drawnParts(i).triangles;
    fmt::print(
        R"({{"benchmark": "model/{}", "triangles": {}, "seconds": {:.3f}, "cpu_seconds": {:.3f}, "triangles_sent": {}, "scene_mb": {:.1f}}})"
        "\n",
        name, triangles, median(seconds), median(cpu), sent, static_cast<double>(renderer->sceneBytes()) / (1 << 20));
  }
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"One pass on eight projectors beside eight plain draws"};
  std::size_t triangles = 1'000'000;
  int rounds = 5;
  int samples = 1;
  app.add_option("--triangles", triangles)->capture_default_str();
  app.add_option("--rounds", rounds)->capture_default_str();
  app.add_option("--samples", samples)->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  devices::HeadlessContext context;
  const viewer::ModelView view{.window = {{4, 1.5}}, .viewer = {.eye = {0, 0, 5}}, .pose = {.zoom = 2.2}};
  struct Kind {
    const char* name;
    bool cull;
    bool keystone;
    bool mask;
    bool correct;
  };
  // All parts eight times; those that each frame shows; these with keystones; held to the display; and with
  // masks.
  constexpr Kind kKinds[] = {{"everything", false, false, false, false},
                             {"plain", true, false, false, false},
                             {"keystone", true, true, false, false},
                             {"unmasked", true, true, false, true},
                             {"one-pass", true, true, true, true}};
  std::vector<Way> ways;
  for (const Kind& kind : kKinds) {
    ways.push_back(
        {kind.name, std::make_unique<viewer::ModelRenderer>(
                        context, frames(kind.keystone, kind.mask),
                        viewer::ModelOptions{.samples = samples, .cull = kind.cull, .correct = kind.correct})});
    ways.back().renderer->setScene(ball(triangles));
  }
  // In turns, so that whatever else the machine does meets all.
  for (int round = -1; round < rounds; ++round) {
    for (auto& way : ways) way.draw(view, round);
  }
  for (const auto& way : ways) way.print(triangles);
  const double onePass = median(ways.back().cpu);
  fmt::print(R"({{"benchmark": "model/ratio", "one_pass_to_plain": {:.2f}, "one_pass_to_everything": {:.2f}}})"
             "\n",
             onePass / median(ways[1].cpu), onePass / median(ways[0].cpu));
  return 0;
}
