// What updates and whole redraws cost in the renderer, beside the bounds that the same GL sets.
#include <epoxy/gl.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "devices/display/gl_context.h"
#include "devices/display/gl_program.h"
#include "tests/bench/curves.h"
#include "tests/gl/plans.h"
#include "viewer/renderer/textures.h"
#include "viewer/renderer/upload_path.h"
#include "viewer/renderer/wall_renderer.h"

namespace pixelflex::testing {
namespace {

using devices::Image16;
using devices::Image8;
using devices::Size;
using viewer::Box;
using viewer::OutputPlan;

constexpr Size kProjector{1024, 768};
constexpr int kMesh = 40;  // cells across and down

double secondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> values) {
  std::ranges::nth_element(values, values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
  return values[values.size() / 2];
}

/// The medians of both, run in turns, so that whatever else the machine does meets both.
std::pair<double, double> inTurns(int rounds, const std::function<void()>& first, const std::function<void()>& second) {
  first();
  second();
  std::vector<double> firsts, seconds;
  for (int i = 0; i < rounds; ++i) {
    firsts.push_back(secondsOf(first));
    seconds.push_back(secondsOf(second));
  }
  return {median(firsts), median(seconds)};
}

/// Everything that a calibrated projector has: blend, gain, even black, colour, responses.
void addLight(OutputPlan& plan) {
  const auto ramp = [](Size size, double from, double to) {
    Image16 map(size, 1);
    for (int y = 0; y < size.height; ++y) {
      for (int x = 0; x < size.width; ++x) {
        map.at(x, y) = static_cast<std::uint16_t>(65535 * (from + (to - from) * x / size.width));
      }
    }
    return map;
  };
  plan.colour = {0.93F, 0.01F, 0.02F, 0.03F, 0.96F, 0.01F, 0.02F, 0.01F, 0.95F};
  plan.alpha = ramp(plan.resolution, 0.4, 1);
  plan.gain = ramp({96, 72}, 1, 0.8);
  plan.black = ramp(plan.resolution, 1, 0);
  plan.largestBlack = {0.004F, 0.0045F, 0.005F};
  for (auto& channel : plan.inverseResponse) {
    for (int i = 0; i < 4096; ++i) channel.push_back(std::pow(static_cast<float>(i) / 4095, 1.04F));
  }
}

/// A wall of columns x rows projectors with overlaps of a tenth, each a little keystoned.
std::vector<OutputPlan> wallOf(int columns, int rows, Size desktop, viewer::Filter filter, int mesh = kMesh) {
  std::vector<OutputPlan> plans;
  for (int i = 0; i < columns * rows; ++i) {
    const glm::dvec2 share(1.0 / columns, 1.0 / rows);
    const glm::dvec2 from = (glm::dvec2(i % columns, static_cast<int>(i / columns)) - 0.05) * share;
    const glm::dvec2 extent = 1.1 * share;
    const auto map = [=](glm::dvec2 p) {
      const glm::dvec2 t(p.x / kProjector.width, p.y / kProjector.height);
      const double w = 1 + 0.06 * (t.x - 0.5) - 0.05 * (t.y - 0.5);
      const glm::dvec2 at = (from + extent * t) * glm::dvec2(desktop.width, desktop.height);
      return glm::dvec3(at * w, w);
    };
    plans.push_back(planOf("p" + std::to_string(i + 1), map, kProjector, desktop, mesh, mesh));
    plans.back().filter = filter;
    addLight(plans.back());
  }
  return plans;
}

viewer::Batch changeAt(Size desktop, const std::vector<Box>& boxes, unsigned seed) {
  viewer::Batch batch;
  batch.desktop = desktop;
  batch.boxes = boxes;
  batch.completesUpdate = true;
  std::size_t bytes = 0;
  for (const auto& box : boxes) bytes += 4 * static_cast<std::size_t>(box.area());
  batch.pixels.resize(bytes);
  for (auto& byte : batch.pixels) {
    seed = seed * 1664525U + 1013904223U;
    byte = static_cast<std::byte>(seed >> 24U);
  }
  return batch;
}

/// A renderer with its wall, drawn once.
class Stand {
 public:
  Stand(const std::vector<OutputPlan>& plans) : renderer_(context_), desktop_(plans.front().desktop) {
    renderer_.setPlans(plans);
    renderer_.draw();
  }

  void update(const viewer::Batch& batch) {
    renderer_.upload(batch);
    renderer_.draw();
  }
  void redraw() {
    renderer_.markAll();
    renderer_.draw();
  }
  [[nodiscard]] viewer::WallRenderer& renderer() { return renderer_; }
  [[nodiscard]] Size desktop() const { return desktop_; }

 private:
  devices::HeadlessContext context_;
  viewer::WallRenderer renderer_;
  Size desktop_;
};

/// The same mesh with one tap of the sampler's own filter and nothing else.
class PlainStand {
 public:
  explicit PlainStand(const OutputPlan& plan)
      : resolution_(plan.resolution), program_("plain", {kVertex}, {kFragment}) {
    desktop_ = viewer::makeTexture(GL_RGBA8, plan.desktop);
    glTextureParameteri(desktop_.get(), GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTextureParameteri(desktop_.get(), GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    const auto pixels = changeAt(plan.desktop, {viewer::boxOf(plan.desktop)}, 1).pixels;
    glTextureSubImage2D(desktop_.get(), 0, 0, 0, plan.desktop.width, plan.desktop.height, GL_RGBA, GL_UNSIGNED_BYTE,
                        pixels.data());
    frame_ = viewer::makeTexture(GL_RGBA8, resolution_);
    framebuffer_ = devices::GlFramebuffer::create();
    glNamedFramebufferTexture(framebuffer_.get(), GL_COLOR_ATTACHMENT0, frame_.get(), 0);
    array_ = devices::GlVertexArray::create();
    vertices_ = devices::GlBuffer::create();
    std::vector<viewer::WarpVertex> corners;
    for (const auto index : plan.mesh.indices) corners.push_back(plan.mesh.vertices[index]);
    count_ = static_cast<GLsizei>(corners.size());
    const auto bytes = std::as_bytes(std::span(corners));
    glNamedBufferStorage(vertices_.get(), static_cast<GLsizeiptr>(bytes.size()), bytes.data(), 0);
    glVertexArrayVertexBuffer(array_.get(), 0, vertices_.get(), 0, sizeof(viewer::WarpVertex));
    for (const GLuint attribute : {0U, 1U}) {
      glEnableVertexArrayAttrib(array_.get(), attribute);
      glVertexArrayAttribFormat(array_.get(), attribute, attribute == 0 ? 2 : 3, GL_FLOAT, GL_FALSE,
                                attribute == 0 ? 0 : offsetof(viewer::WarpVertex, uw));
      glVertexArrayAttribBinding(array_.get(), attribute, 0);
    }
    program_.set("resolution", glm::vec2(resolution_.width, resolution_.height));
    program_.set("desktopSize", glm::vec2(plan.desktop.width, plan.desktop.height));
  }

  void redraw() const {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_.get());
    glDisable(GL_SCISSOR_TEST);
    glViewport(0, 0, resolution_.width, resolution_.height);
    glBindVertexArray(array_.get());
    glBindTextureUnit(0, desktop_.get());
    program_.use();
    glDrawArrays(GL_TRIANGLES, 0, count_);
    glFinish();
  }

 private:
  static constexpr const char* kVertex =
      "layout(location = 0) in vec2 p; layout(location = 1) in vec3 t; uniform vec2 resolution;\n"
      "noperspective out vec3 at; void main() { gl_Position = vec4(2.0 * p / resolution - 1.0, 0.0, 1.0); at = t; }\n";
  static constexpr const char* kFragment =
      "noperspective in vec3 at; layout(location = 0) out vec4 device; uniform sampler2D desktop;\n"
      "uniform vec2 desktopSize; void main() { device = texture(desktop, at.xy / at.z / desktopSize); }\n";

  Size resolution_;
  devices::GlProgram program_;
  devices::GlTexture desktop_, frame_;
  devices::GlFramebuffer framebuffer_;
  devices::GlVertexArray array_;
  devices::GlBuffer vertices_;
  GLsizei count_ = 0;
};

/// The same maths on the processor: OpenCV's cubic remap, light, colour, mask, black and response, by its own threads.
class OpenCvStand {
 public:
  OpenCvStand(const std::vector<OutputPlan>& plans, Size desktop) : desktop_(desktop.height, desktop.width, CV_8UC4) {
    cv::setNumThreads(2);
    cv::randu(desktop_, 0, 256);
    for (int code = 0; code < 256; ++code) {
      const float c = static_cast<float>(code) / 255;
      decode_.push_back(c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F));
    }
    for (int i = 0; i < 4096; ++i) {
      encode_.push_back(static_cast<std::uint8_t>(std::lround(255 * std::pow(i / 4095.0, 1 / 2.2))));
    }
    for (const auto& plan : plans) projectors_.push_back(projectorOf(plan));
  }

  void redraw() {
    for (auto& projector : projectors_) redraw(projector);
  }

 private:
  struct Projector {
    cv::Mat mapX, mapY, mask, black, warped, light, frame;
    cv::Matx33f colour;
  };

  static Projector projectorOf(const OutputPlan& plan) {
    Projector projector;
    const auto [width, height] = plan.resolution;
    cv::Mat x(height, width, CV_32FC1), y(height, width, CV_32FC1);
    // The plan's map as the mesh's outermost corners tell it; OpenCV need not follow the mesh to cost what it costs.
    const auto& first = plan.mesh.vertices.front();
    for (int row = 0; row < height; ++row) {
      for (int column = 0; column < width; ++column) {
        x.at<float>(row, column) = first.uw / first.w + static_cast<float>(column) * 1.1F;
        y.at<float>(row, column) = first.vw / first.w + static_cast<float>(row) * 1.1F;
      }
    }
    cv::convertMaps(x, y, projector.mapX, projector.mapY, CV_16SC2);
    cv::Mat(height, width, CV_16UC1, const_cast<std::uint16_t*>(plan.alpha.samples().data()))
        .convertTo(projector.mask, CV_32F, 1 / 65535.0);
    cv::Mat(height, width, CV_16UC1, const_cast<std::uint16_t*>(plan.black.samples().data()))
        .convertTo(projector.black, CV_32F, 0.004 / 65535.0);
    projector.frame.create(height, width, CV_8UC3);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) projector.colour(i, j) = plan.colour[j][i];
    }
    return projector;
  }

  void redraw(Projector& projector) const {
    cv::remap(desktop_, projector.warped, projector.mapX, projector.mapY, cv::INTER_CUBIC, cv::BORDER_CONSTANT);
    cv::parallel_for_(cv::Range(0, projector.frame.rows), [&](const cv::Range& range) {
      for (int row = range.start; row < range.end; ++row) finishRow(projector, row);
    });
  }

  void finishRow(Projector& projector, int row) const {
    const auto* from = projector.warped.ptr<cv::Vec4b>(row);
    const auto* mask = projector.mask.ptr<float>(row);
    const auto* black = projector.black.ptr<float>(row);
    auto* to = projector.frame.ptr<cv::Vec3b>(row);
    for (int column = 0; column < projector.frame.cols; ++column) {
      const cv::Vec3f light(decode_[from[column][0]], decode_[from[column][1]], decode_[from[column][2]]);
      const cv::Vec3f matched = projector.colour * light;
      for (int c = 0; c < 3; ++c) {
        const float value = std::clamp(matched[c] * mask[column] + black[column], 0.0F, 1.0F);
        to[column][c] = encode_[static_cast<std::size_t>(value * 4095)];
      }
    }
  }

  cv::Mat desktop_;
  std::vector<float> decode_;
  std::vector<std::uint8_t> encode_;
  std::vector<Projector> projectors_;
};

void print(const std::string& name, const std::string& figures) {
  fmt::print("{{\"benchmark\": \"{}\", {}}}\n", name, figures);
  std::fflush(stdout);
}

void corners() {
  const Size desktop{15360, 4320};
  Stand stand(wallOf(4, 2, desktop, viewer::Filter::kCatmullRom));
  const auto before = stand.renderer().stats();
  stand.update(changeAt(desktop, {{0, 0, 64, 64}, {15296, 4256, 15360, 4320}}, 7));
  const auto after = stand.renderer().stats();
  print("corners", fmt::format(R"("bytes_uploaded": {}, "pixels_drawn": {})",
                               after.bytesUploaded - before.bytesUploaded, after.pixelsDrawn - before.pixelsDrawn));
}

/// What the viewer measures at its start to choose how the desktop's pixels reach the GPU.
void uploads() {
  devices::HeadlessContext context;
  const auto rates = viewer::measureUploads(context);
  print("uploads", fmt::format(R"("paths": "{}")", viewer::describeUploads(rates)));
}

/// One 64x64 change in the middle of the first projector, in upload, marking and drawing.
void smallChange(int rounds, Size largeDesktop) {
  const auto boxIn = [](Size desktop, int columns, int rows) {
    const int x = desktop.width / columns / 2, y = desktop.height / rows / 2;
    return Box{x, y, x + 64, y + 64};
  };
  Stand one(wallOf(1, 1, {1024, 768}, viewer::Filter::kCatmullRom));
  Stand eight(wallOf(4, 2, largeDesktop, viewer::Filter::kCatmullRom));
  const auto small = changeAt(one.desktop(), {boxIn(one.desktop(), 1, 1)}, 3);
  const auto large = changeAt(eight.desktop(), {boxIn(eight.desktop(), 4, 2)}, 3);
  const auto times = inTurns(
      20 * rounds, [&] { one.update(small); }, [&] { eight.update(large); });
  print("change/size", fmt::format(R"("one_projector_us": {:.1f}, "eight_projectors_us": {:.1f}, "ratio": {:.2f})",
                                   1e6 * times.first, 1e6 * times.second, times.second / times.first));
  const auto whole = inTurns(
      rounds, [&] { eight.update(large); }, [&] { eight.redraw(); });
  print("change/redraw", fmt::format(R"("change_us": {:.1f}, "redraw_us": {:.1f}, "ratio": {:.5f})", 1e6 * whole.first,
                                     1e6 * whole.second, whole.first / whole.second));
}

void againstPlain(int rounds) {
  const Size desktop{1280, 960};
  for (const auto& [name, filter] :
       {std::pair("bilinear", viewer::Filter::kBilinear), std::pair("catmull-rom", viewer::Filter::kCatmullRom)}) {
    const auto plans = wallOf(1, 1, desktop, filter);
    Stand stand(plans);
    stand.update(changeAt(desktop, {viewer::boxOf(desktop)}, 1));
    const PlainStand plain(plans.front());
    const auto times = inTurns(
        rounds, [&] { plain.redraw(); }, [&] { stand.redraw(); });
    print(fmt::format("redraw/{}", name),
          fmt::format(R"("plain_ms": {:.2f}, "ours_ms": {:.2f}, "ratio": {:.2f})", 1e3 * times.first,
                      1e3 * times.second, times.second / times.first));
  }
}

void againstOpenCv(int rounds) {
  const Size desktop{3400, 1500};
  const auto plans = wallOf(4, 2, desktop, viewer::Filter::kCatmullRom);
  Stand stand(plans);
  const auto update = changeAt(desktop, {viewer::boxOf(desktop)}, 1);
  OpenCvStand opencv(plans, desktop);
  const auto times = inTurns(
      rounds, [&] { opencv.redraw(); }, [&] { stand.update(update); });
  print("everything",
        fmt::format(R"("opencv_ms": {:.1f}, "ours_ms": {:.1f}, "frames_per_second": {:.1f}, "ratio": {:.2f})",
                    1e3 * times.first, 1e3 * times.second, 1 / times.second, times.first / times.second));
}

double timeOf(int rounds, const std::function<void()>& work) {
  work();
  std::vector<double> times;
  for (int i = 0; i < rounds; ++i) times.push_back(secondsOf(work));
  return median(times);
}

/// A square of so many pixels, or as much as the desktop holds.
Box squareOf(Size desktop, double pixels) {
  const int width = std::min(desktop.width, static_cast<int>(std::lround(std::sqrt(pixels))));
  const int height = std::min(desktop.height, static_cast<int>(std::lround(pixels / width)));
  return {0, 0, width, height};
}

void addPoint(Curve& curve, double across, double seconds) {
  curve.points.emplace_back(across, seconds);
  print("curve", fmt::format(R"("title": "{}", "at": {}, "us": {:.1f})", curve.title, across, 1e6 * seconds));
}

/// How what an update costs grows: upload, marking and drawing.
std::vector<Curve> curves(int rounds, Size largest) {
  Curve byArea{"one change, by its area", "changed pixels of the desktop", {}};
  {
    Stand stand(wallOf(4, 2, largest, viewer::Filter::kCatmullRom));
    const auto most = static_cast<double>(largest.area());
    for (double pixels = 1; pixels <= std::min(most, std::pow(2, 26)); pixels *= 4) {
      const auto change = changeAt(largest, {squareOf(largest, pixels)}, 5);
      addPoint(byArea, pixels, timeOf(rounds, [&] { stand.update(change); }));
    }
  }
  Curve bySize{"64x64 pixels, by the desktop's size", "pixels of the desktop", {}};
  for (Size desktop{1024, 512}; desktop.width <= largest.width; desktop = {2 * desktop.width, 2 * desktop.height}) {
    Stand stand(wallOf(4, 2, desktop, viewer::Filter::kCatmullRom));
    const auto change = changeAt(desktop, {{0, 0, 64, 64}}, 5);
    addPoint(bySize, static_cast<double>(desktop.area()), timeOf(10 * rounds, [&] { stand.update(change); }));
  }
  Curve byCount{"64x64 pixels, by the number of projectors", "projectors", {}};
  for (int columns = 1; columns <= 16; columns *= 2) {
    const Size desktop{900 * columns, 700};
    Stand stand(wallOf(columns, 1, desktop, viewer::Filter::kCatmullRom));
    const auto change = changeAt(desktop, {{300, 300, 364, 364}}, 5);
    addPoint(byCount, columns, timeOf(10 * rounds, [&] { stand.update(change); }));
  }
  Curve byMesh{"64x64 pixels, by the mesh", "triangles of a projector", {}};
  for (int mesh = 5; mesh <= 160; mesh *= 2) {
    const Size desktop{1200, 900};
    Stand stand(wallOf(1, 1, desktop, viewer::Filter::kCatmullRom, mesh));
    const auto change = changeAt(desktop, {{300, 300, 364, 364}}, 5);
    addPoint(byMesh, 2.0 * mesh * mesh, timeOf(10 * rounds, [&] { stand.update(change); }));
  }
  return {byArea, bySize, byCount, byMesh};
}

}  // namespace
}  // namespace pixelflex::testing

int main(int argc, char** argv) {
  using namespace pixelflex::testing;
  int rounds = 15;
  std::vector<std::string> what{"uploads", "corners", "change", "redraw", "everything"};
  bool tiny = false;
  std::string picture;
  CLI::App app("What updates and redraws cost in the renderer. A line of JSON for each figure; medians.");
  app.add_option("--rounds", rounds)->check(CLI::Range(1, 10000));
  app.add_option("--what", what)->delimiter(',')->check(CLI::IsMember(what));
  app.add_flag("--tiny", tiny, "a small desktop, to see that it works");
  app.add_option("--curves", picture,
                 "an SVG file: how the cost of an update grows with what changed and what is there");
  CLI11_PARSE(app, argc, argv);
  const auto wanted = [&what](const char* name) { return std::ranges::find(what, name) != what.end(); };
  try {
    if (wanted("uploads")) uploads();
    if (wanted("corners")) corners();
    const Size largest = tiny ? Size{4096, 2048} : Size{16384, 8192};
    if (wanted("change")) smallChange(rounds, largest);
    if (wanted("redraw")) againstPlain(rounds);
    if (wanted("everything")) againstOpenCv(rounds);
    if (!picture.empty()) drawCurves(curves(rounds, largest), picture);
  } catch (const std::exception& error) {
    fmt::print(stderr, "redraw_bench: {}\n", error.what());
    return 1;
  }
}
