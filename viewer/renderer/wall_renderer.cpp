#include "viewer/renderer/wall_renderer.h"

#include <epoxy/gl.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "viewer/renderer/renderer_error.h"

namespace pixelflex::viewer {
namespace {

/// Adds the time until its end to a sum.
class Stopwatch {
 public:
  explicit Stopwatch(std::chrono::nanoseconds& sum) : sum_(sum) {}
  ~Stopwatch() { sum_ += std::chrono::steady_clock::now() - begin_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  std::chrono::nanoseconds& sum_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

void prepareState() {
  glDisable(GL_DITHER);  // the driver's own; ours is in the shader
  glDisable(GL_BLEND);
  glDisable(GL_CULL_FACE);
  glDisable(GL_DEPTH_TEST);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glEnable(GL_SCISSOR_TEST);
}

FrameFormat formatOf(const RendererOptions& options) {
  assert(options.bitsPerColour == 8 || options.bitsPerColour == 10);
  if (options.measure) return FrameFormat::kRgba32F;
  return options.bitsPerColour == 10 ? FrameFormat::kRgb10 : FrameFormat::kRgba8;
}

}  // namespace

WallRenderer::WallRenderer(devices::GlContext& context, RendererOptions options)
    : context_(context), options_(options) {
  context_.makeCurrent();
  if (options.upload.memory == UploadPath::Memory::kMapped) uploadMemory_ = std::make_unique<UploadMemory>();
}

WallRenderer::~WallRenderer() {
  try {
    context_.makeCurrent();
  } catch (const devices::DisplayError&) {
    // The context is gone and its objects with it; deleting their names is then without effect.
    return;
  }
}

bool WallRenderer::setPlans(const std::vector<OutputPlan>& plans) {
  if (plans.empty()) throw RendererError("nothing to draw: no output has a plan");
  const auto size = plans.front().desktop;
  if (size.width <= 0 || size.height <= 0) throw RendererError("the desktop of the plans is empty");
  context_.makeCurrent();
  const TileLayout layout(size);
  std::vector<Output> outputs;
  for (const auto& plan : plans) {
    if (plan.desktop != size) {
      throw RendererError(fmt::format("output '{}' shows a desktop of {}x{}, output '{}' one of {}x{}", plan.name,
                                      plan.desktop.width, plan.desktop.height, plans.front().name, size.width,
                                      size.height));
    }
    outputs.emplace_back(plan, layout, formatOf(options_)).setBrightness(brightness_);
  }
  const bool lost = !desktop_ || desktop_->layout().desktop() != size;
  if (lost) {
    if (desktop_) bytesOfOldDesktops_ += desktop_->bytesUploaded();
    outputs_.clear();
    desktop_.reset();  // first, so that two desktops never exist at once
    desktop_.emplace(size, options_.measure ? TexelFormat::kRgba32F : TexelFormat::kRgba8,
                     options_.measure ? UploadPath::Order::kRgba : options_.upload.order, uploadMemory_.get());
    updateOpen_ = false;
  }
  outputs_ = std::move(outputs);
  for (auto& output : outputs_) output.showDamage(showsDamage_);
  if (panelOutput_ < outputs_.size()) outputs_[panelOutput_].setPanel(panel_);
  return lost;
}

void WallRenderer::markWhere(const Box& desktopBox) {
  if (desktopBox.empty()) return;
  const Stopwatch stopwatch(stats_.markTime);
  for (auto& output : outputs_) output.mark(desktopBox);
}

void WallRenderer::upload(const Batch& batch) {
  assert(desktop_ && !options_.measure);
  updateOpen_ = !batch.completesUpdate;
  if (batch.boxes.empty()) return;
  context_.makeCurrent();
  {
    const Stopwatch stopwatch(stats_.uploadTime);
    desktop_->upload(batch.boxes, batch.pixels);
    stats_.boxesUploaded += batch.boxes.size();
  }
  for (const auto& box : batch.boxes) markWhere(box);
}

void WallRenderer::uploadDesktop(const devices::ImageF& desktop) {
  assert(desktop_ && options_.measure && desktop.channels() == 4);
  context_.makeCurrent();
  const Box whole = boxOf(desktop.size());
  desktop_->upload(std::span(&whole, 1), std::as_bytes(desktop.samples()));
  markWhere(whole);
}

void WallRenderer::copyDesktop(devices::GlName picture) {
  assert(desktop_);
  context_.makeCurrent();
  desktop_->copy(picture);
  markWhere(boxOf(desktop_->layout().desktop()));
}

template <class Change>
void WallRenderer::changeCursor(const Change& change) {
  const auto before = cursor_.box();
  change();
  markWhere(before);
  markWhere(cursor_.box());
}

void WallRenderer::setCursor(const devices::Image8& image, glm::ivec2 hotspot) {
  context_.makeCurrent();
  changeCursor([&] { cursor_.setImage(image, hotspot); });
}

void WallRenderer::moveCursor(glm::ivec2 position) {
  changeCursor([&] { cursor_.moveTo(position); });
}

void WallRenderer::showCursor(bool shown) {
  changeCursor([&] { cursor_.show(shown); });
}

void WallRenderer::setBrightness(float brightness) {
  if (brightness == brightness_) return;
  brightness_ = brightness;
  for (auto& output : outputs_) output.setBrightness(brightness);
}

void WallRenderer::setPanel(std::size_t output, const devices::Image8& panel) {
  context_.makeCurrent();
  if (output != panelOutput_ && panelOutput_ < outputs_.size()) outputs_[panelOutput_].setPanel({});
  panelOutput_ = output;
  panel_ = panel;
  if (output < outputs_.size()) outputs_[output].setPanel(panel);
}

void WallRenderer::showDamage(bool shown) {
  showsDamage_ = shown;
  for (auto& output : outputs_) output.showDamage(shown);
}

void WallRenderer::fadeDamage() {
  for (auto& output : outputs_) output.fadeDamage();
}

bool WallRenderer::fading() const {
  return std::ranges::any_of(outputs_, &Output::fading);
}

void WallRenderer::markAll() {
  for (auto& output : outputs_) output.markAll();
}

bool WallRenderer::needsDraw() const {
  return !updateOpen_ && std::any_of(outputs_.begin(), outputs_.end(), [](const auto& o) { return o.marked(); });
}

std::vector<std::size_t> WallRenderer::draw() {
  std::vector<std::size_t> drawn;
  if (!desktop_ || !needsDraw()) return drawn;
  const Stopwatch stopwatch(stats_.drawTime);
  context_.makeCurrent();
  prepareState();
  for (std::size_t i = 0; i < outputs_.size(); ++i) {
    if (!outputs_[i].marked()) continue;
    stats_.pixelsDrawn += outputs_[i].draw(*desktop_, cursor_, programs_);
    drawn.push_back(i);
  }
  glDisable(GL_SCISSOR_TEST);
  glFinish();  // another context may show the frames next
  ++stats_.frames;
  stats_.outputsDrawn += drawn.size();
  return drawn;
}

const std::string& WallRenderer::outputName(std::size_t output) const {
  return outputs_.at(output).name();
}

devices::Size WallRenderer::outputResolution(std::size_t output) const {
  return outputs_.at(output).resolution();
}

const Region& WallRenderer::outputDrawn(std::size_t output) const {
  return outputs_.at(output).drawn();
}

devices::GlName WallRenderer::outputTexture(std::size_t output) const {
  return outputs_.at(output).texture();
}

devices::Image8 WallRenderer::readOutput(std::size_t output) {
  const Stopwatch stopwatch(stats_.readTime);
  context_.makeCurrent();
  return outputs_.at(output).read();
}

devices::Image16 WallRenderer::readOutput16(std::size_t output) {
  const Stopwatch stopwatch(stats_.readTime);
  context_.makeCurrent();
  return outputs_.at(output).read16();
}

devices::ImageF WallRenderer::readOutputFloat(std::size_t output) {
  const Stopwatch stopwatch(stats_.readTime);
  context_.makeCurrent();
  return outputs_.at(output).readFloat();
}

devices::Image8 WallRenderer::readDesktop() {
  assert(desktop_);
  const Stopwatch stopwatch(stats_.readTime);
  context_.makeCurrent();
  return desktop_->read();
}

RenderStats WallRenderer::stats() const {
  auto stats = stats_;
  stats.bytesUploaded = bytesOfOldDesktops_ + (desktop_ ? desktop_->bytesUploaded() : 0);
  return stats;
}

}  // namespace pixelflex::viewer
