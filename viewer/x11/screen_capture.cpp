#include "viewer/x11/screen_capture.h"

#include <xcb/damage.h>
#include <xcb/shm.h>
#include <xcb/xcb.h>
#include <xcb/xfixes.h>

#include <algorithm>
#include <bit>
#include <cassert>

#include "viewer/tiles/thread_time.h"
#include "viewer/vnc/session_error.h"

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kBytesPerPixel = 4;
// More boxes than this are not worth telling apart.
constexpr int kMaxRectangles = 1024;
constexpr int kMaxFailures = 20;

std::size_t bytesOf(const Box& box) {
  return static_cast<std::size_t>(box.area()) * kBytesPerPixel;
}

const xcb_visualtype_t* findVisual(const xcb_screen_t& screen) {
  for (auto depth = xcb_screen_allowed_depths_iterator(&screen); depth.rem > 0; xcb_depth_next(&depth)) {
    for (auto visual = xcb_depth_visuals_iterator(depth.data); visual.rem > 0; xcb_visualtype_next(&visual)) {
      if (visual.data->visual_id == screen.root_visual) return visual.data;
    }
  }
  return nullptr;
}

int bitsPerPixel(const xcb_setup_t& setup, int depth) {
  for (auto format = xcb_setup_pixmap_formats_iterator(&setup); format.rem > 0; xcb_format_next(&format)) {
    if (format.data->depth == depth) return format.data->bits_per_pixel;
  }
  return 0;
}

bool isByte(std::uint32_t mask) {
  return mask != 0 && mask >> std::countr_zero(mask) == 0xff;
}

Box boxOf(const xcb_rectangle_t& rectangle) {
  return {rectangle.x, rectangle.y, rectangle.x + rectangle.width, rectangle.y + rectangle.height};
}

}  // namespace

ScreenCapture::ScreenCapture(const XConnection& connection) : connection_(connection), root_(connection.root()) {
  requireFormat();
  useExtensions();
  damage_ = connection.newId();
  region_ = connection.newId();
  segment_ = connection.newId();
  xcb_connection_t* x = connection.get();
  // Tells of resizes.
  const std::uint32_t mask = XCB_EVENT_MASK_STRUCTURE_NOTIFY;
  xcb_change_window_attributes(x, root_, XCB_CW_EVENT_MASK, &mask);
  xcb_xfixes_create_region(x, region_, 0, nullptr);
  xcb_damage_create(x, damage_, root_, XCB_DAMAGE_REPORT_LEVEL_NON_EMPTY);
  checkSize();
}

ScreenCapture::~ScreenCapture() = default;

void ScreenCapture::useExtensions() {
  xcb_connection_t* x = connection_.get();
  connection_.requireExtension("XFIXES");
  connection_.requireExtension("MIT-SHM");
  damageEvent_ = connection_.requireExtension("DAMAGE").firstEvent + XCB_DAMAGE_NOTIFY;
  (void)connection_.reply<xcb_xfixes_query_version_reply_t>(xcb_xfixes_query_version(x, 5, 0));
  (void)connection_.reply<xcb_damage_query_version_reply_t>(xcb_damage_query_version(x, 1, 1));
  const auto shm = connection_.reply<xcb_shm_query_version_reply_t>(xcb_shm_query_version(x));
  const bool takesDescriptors = shm != nullptr && (shm->major_version > 1 || shm->minor_version >= 2);
  if (!takesDescriptors) connection_.refuse("is too old: it needs MIT-SHM 1.2");
}

void ScreenCapture::requireFormat() {
  const xcb_setup_t& setup = *xcb_get_setup(connection_.get());
  auto screens = xcb_setup_roots_iterator(&setup);
  while (screens.data->root != root_) xcb_screen_next(&screens);
  const xcb_visualtype_t* visual = findVisual(*screens.data);
  const bool fits = visual != nullptr && visual->_class == XCB_VISUAL_CLASS_TRUE_COLOR &&
                    bitsPerPixel(setup, screens.data->root_depth) == 32 && isByte(visual->red_mask) &&
                    isByte(visual->green_mask) && isByte(visual->blue_mask) &&
                    setup.image_byte_order == XCB_IMAGE_ORDER_LSB_FIRST;
  if (!fits) {
    connection_.refuse("has a screen of depth " + std::to_string(screens.data->root_depth) +
                       " with pixels that cannot be shown: start it with depth 24, true colour");
  }
  layout_ = {std::countr_zero(visual->red_mask), std::countr_zero(visual->green_mask),
             std::countr_zero(visual->blue_mask)};
}

void ScreenCapture::handle(const XEvent& event) {
  if (event.type() == damageEvent_) {
    damaged_ = true;
  } else if (event.type() == XCB_CONFIGURE_NOTIFY) {
    const auto& configured = event.as<xcb_configure_notify_event_t>();
    if (configured.window == root_) adopt({configured.width, configured.height});
  }
}

void ScreenCapture::checkSize() {
  const auto geometry = connection_.reply<xcb_get_geometry_reply_t>(xcb_get_geometry(connection_.get(), root_));
  if (geometry == nullptr) throw SessionError(CloseKind::kLost, "the X server has no screen any more");
  adopt({geometry->width, geometry->height});
}

void ScreenCapture::adopt(devices::Size size) {
  if (size == size_) return;
  const std::size_t bytes = bytesOf(boxOf(size));
  if (bytes > pixels_.bytes().size()) {
    if (!pixels_.bytes().empty()) xcb_shm_detach(connection_.get(), segment_);
    pixels_ = SharedPixels(bytes);
    xcb_shm_attach_fd(connection_.get(), segment_, pixels_.duplicateDescriptor(), 0);
  }
  size_ = size;
  whole_ = true;
  damaged_ = true;
}

bool ScreenCapture::publish(std::uint64_t serial, FrameBelt& belt, const std::stop_token& stop) {
  const auto received = std::chrono::steady_clock::now();
  const auto before = threadTime();
  Region damage = takeDamage();
  if (damage.empty()) return false;
  if (!fetch(damage)) {
    whole_ = damaged_ = true;
    if (++failures_ > kMaxFailures) connection_.refuse("gives no picture of its screen");
    checkSize();
    return false;
  }
  failures_ = 0;
  const auto bytes = static_cast<std::size_t>(damage.area()) * kBytesPerPixel;
  const PackedUpdate update{
      serial, received, size_, std::move(damage), pixels_.bytes().first(bytes), layout_, threadTime() - before};
  if (!publishPacked(update, belt, stop)) throw SessionStopped{};
  return true;
}

Region ScreenCapture::takeDamage() {
  xcb_connection_t* x = connection_.get();
  // What is drawn from here on is damage again.
  xcb_damage_subtract(x, damage_, XCB_NONE, region_);
  const auto fetched = connection_.reply<xcb_xfixes_fetch_region_reply_t>(xcb_xfixes_fetch_region(x, region_));
  damaged_ = false;
  Region damage;
  if (std::exchange(whole_, false) || fetched == nullptr) {
    damage.add(viewer::boxOf(size_));
    return damage;
  }
  const int count = xcb_xfixes_fetch_region_rectangles_length(fetched.get());
  const std::span rectangles(xcb_xfixes_fetch_region_rectangles(fetched.get()), static_cast<std::size_t>(count));
  if (count > kMaxRectangles) {
    damage.add(intersect(boxOf(fetched->extents), viewer::boxOf(size_)));
  } else {
    for (const auto& rectangle : rectangles) damage.add(intersect(boxOf(rectangle), viewer::boxOf(size_)));
  }
  return damage;
}

bool ScreenCapture::fetch(const Region& region) {
  xcb_connection_t* x = connection_.get();
  std::vector<xcb_shm_get_image_cookie_t> cookies;
  std::size_t offset = 0;
  for (const Box& box : region.boxes()) {
    cookies.push_back(xcb_shm_get_image(x, root_, static_cast<std::int16_t>(box.left),
                                        static_cast<std::int16_t>(box.top), static_cast<std::uint16_t>(box.width()),
                                        static_cast<std::uint16_t>(box.height()), ~0U, XCB_IMAGE_FORMAT_Z_PIXMAP,
                                        segment_, static_cast<std::uint32_t>(offset)));
    offset += bytesOf(box);
  }
  assert(offset <= pixels_.bytes().size());
  bool all = true;
  for (const auto& cookie : cookies) all = connection_.reply<xcb_shm_get_image_reply_t>(cookie) != nullptr && all;
  return all;
}

}  // namespace pixelflex::viewer
