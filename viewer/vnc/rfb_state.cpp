#include "viewer/vnc/rfb_state.h"

#include <rfb/rfbclient.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <mutex>
#include <new>
#include <string>
#include <utility>

#include "viewer/vnc/connector.h"
#include "viewer/vnc/rfb_cursor.h"
#include "viewer/vnc/rfb_messages.h"

// libvncclient's own JPEG decoder; exported, but in no header.
extern "C" int tjDestroy(void* decoder);

namespace pixelflex::viewer {
namespace {

constexpr int kMaxCursorExtent = 1024;

// Its address names our data among a client's.
char clientDataTag = 0;

RfbState& stateOf(rfbClient* client) {
  return *static_cast<RfbState*>(rfbClientGetClientData(client, &clientDataTag));
}

rfbBool onMalloc(rfbClient* client) noexcept {
  return stateOf(client).allocate() ? TRUE : FALSE;
}

void onRect(rfbClient* client, int x, int y, int w, int h) noexcept {
  RfbState& state = stateOf(client);
  if (std::exchange(state.pseudoRect, false)) return;
  state.damage.add(intersect({x, y, x + w, y + h}, boxOf(state.pixelsSize)));
}

void onFinished(rfbClient* client) noexcept {
  stateOf(client).updateFinished = true;
}

void onCursor(rfbClient* client, int hotX, int hotY, int width, int height, int) noexcept {
  const devices::Size size{width, height};
  const auto area = static_cast<std::size_t>(size.area());
  CursorShape shape = cursorFromMask(size, {client->rcSource, 4 * area}, {client->rcMask, area});
  shape.hotX = hotX;
  shape.hotY = hotY;
  stateOf(client).events.emplace_back(std::move(shape));
  // libvncclient allocates a new mask for each cursor and forgets the old one.
  std::free(std::exchange(client->rcMask, nullptr));
}

rfbBool onPointer(rfbClient* client, int x, int y) noexcept {
  stateOf(client).events.emplace_back(CursorMoved{x, y});
  return TRUE;
}

rfbBool onEncoding(rfbClient* client, rfbFramebufferUpdateRectHeader* rect) noexcept {
  RfbState& state = stateOf(client);
  const auto encoding = static_cast<std::int32_t>(rect->encoding);
  if (encoding != kVmwareCursorPositionEncoding && encoding != kCursorWithAlphaEncoding) return FALSE;
  state.pseudoRect = true;
  if (encoding == kVmwareCursorPositionEncoding) return onPointer(client, rect->r.x, rect->r.y);
  try {
    state.readAlphaCursor({rect->r.w, rect->r.h}, rect->r.x, rect->r.y);
    return TRUE;
  } catch (const SessionError& error) {
    state.failure = error;
    return FALSE;
  }
}

void registerEncodings() {
  static std::array<int, 3> encodings{kCursorWithAlphaEncoding, kVmwareCursorPositionEncoding, 0};
  static rfbClientProtocolExtension extension{encodings.data(), onEncoding, nullptr, nullptr, nullptr, nullptr};
  static std::once_flag once;
  std::call_once(once, [] { rfbClientRegisterExtension(&extension); });
}

}  // namespace

RfbState::RfbState(int socket, const SessionOptions& sessionOptions)
    : options(sessionOptions), client(rfbGetClient(8, 3, 4)) {
  registerEncodings();
  where = describeServer(options.server);
  if (client == nullptr) throw std::bad_alloc();
  rfbClientSetClientData(client, &clientDataTag, this);
  client->sock = socket;
  client->MallocFrameBuffer = onMalloc;
  client->GotFrameBufferUpdate = onRect;
  client->FinishedFrameBufferUpdate = onFinished;
  client->GotCursorShape = onCursor;
  client->HandleCursorPos = onPointer;
}

RfbState::~RfbState() {
  std::free(client->rcSource);
  std::free(client->rcMask);
  if (client->tjhnd != nullptr) tjDestroy(client->tjhnd);  // nobody else does
  client->sock = RFB_INVALID_SOCKET;                       // neither is libvncclient's to close
  client->tlsSession = nullptr;
  rfbClientCleanup(client);
}

void RfbState::fail() const {
  if (failure) throw SessionError(*failure);
  throw streamFailure(where, insideUpdate, log);
}

void RfbState::read(std::span<std::uint8_t> bytes) const {
  if (bytes.empty()) return;  // libvncclient takes no null pointer, not even for no bytes
  if (!ReadFromRFBServer(client, reinterpret_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()))) fail();
}

void RfbState::discard(std::uint64_t count) const {
  std::array<std::uint8_t, 4096> bin{};
  while (count > 0) {
    const std::size_t part = std::min<std::uint64_t>(count, bin.size());
    read(std::span(bin).first(part));
    count -= part;
  }
}

void RfbState::write(std::span<const std::uint8_t> message) const {
  if (!WriteToRFBServer(client, reinterpret_cast<const char*>(message.data()), static_cast<unsigned>(message.size()))) {
    fail();
  }
}

// Pages that nothing was written to take no memory: calloc maps them on demand.
bool RfbState::allocate() noexcept {
  const devices::Size size{client->width, client->height};
  const std::string extent = std::to_string(size.width) + "x" + std::to_string(size.height);
  if (size.width <= 0 || size.height <= 0) {
    failure = SessionError(CloseKind::kProtocol, where + " announces a desktop of " + extent + " pixels");
    return false;
  }
  if (size.width > kMaxDesktopExtent || size.height > kMaxDesktopExtent) {
    const std::string most = std::to_string(kMaxDesktopExtent);
    failure = SessionError(CloseKind::kTooLarge, "the server's desktop is " + extent + "; at most " + most + "x" +
                                                     most + " is supported; start it with a smaller -geometry");
    return false;
  }
  std::unique_ptr<std::uint8_t, Free> fresh(
      static_cast<std::uint8_t*>(std::calloc(static_cast<std::size_t>(size.area()), 4)));
  if (fresh == nullptr) {
    failure = SessionError(CloseKind::kTooLarge, "not enough memory for the server's desktop of " + extent);
    return false;
  }
  const devices::Size common{std::min(size.width, pixelsSize.width), std::min(size.height, pixelsSize.height)};
  for (int y = 0; y < common.height; ++y) {
    std::memcpy(
        fresh.get() + std::size_t{4} * static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width),
        pixels.get() + std::size_t{4} * static_cast<std::size_t>(y) * static_cast<std::size_t>(pixelsSize.width),
        std::size_t{4} * static_cast<std::size_t>(common.width));
  }
  const bool changed = pixels != nullptr && size != pixelsSize;
  pixels = std::move(fresh);
  pixelsSize = size;
  client->frameBuffer = pixels.get();
  firstPixel.reset();
  damage.clear();
  if (changed) {
    damage.add(boxOf(size));
    events.emplace_back(Resized{size});
  }
  return true;
}

// Between two attempts libvncclient waits for a tenth of a second; it gives up at the eleventh in vain when told to
// wait for one second.
void RfbState::limitReading() const {
  constexpr int kAttempts = 11;
  constexpr std::chrono::milliseconds kBetween{100};
  client->readTimeout = 1;
  const auto each = std::max(options.patience / kAttempts - kBetween, std::chrono::milliseconds(1));
  const auto seconds = std::chrono::floor<std::chrono::seconds>(each);
  const timeval limit{.tv_sec = seconds.count(), .tv_usec = std::chrono::microseconds(each - seconds).count()};
  ::setsockopt(client->sock, SOL_SOCKET, SO_RCVTIMEO, &limit, sizeof limit);
}

bool RfbState::isOnlySignOfLife() {
  const auto before = firstPixel;
  firstPixel.emplace();
  std::copy_n(pixels.get(), firstPixel->size(), firstPixel->begin());
  return before == firstPixel && damage.boxes().size() == 1 && damage.boxes().front() == Box{0, 0, 1, 1};
}

void RfbState::readAlphaCursor(devices::Size size, int hotX, int hotY) {
  std::array<std::uint8_t, 4> encoding{};
  read(encoding);
  if (bigEndian(encoding) != 0 || size.width > kMaxCursorExtent || size.height > kMaxCursorExtent) {
    throw SessionError(CloseKind::kProtocol, where + " sent a pointer shape that cannot be read");
  }
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(size.area()));
  read(rgba);
  CursorShape shape = cursorFromPremultiplied(size, rgba);
  pointerDrawn = size.area() == 0;  // or the pointer is hidden, which looks the same
  shape.hotX = hotX;
  shape.hotY = hotY;
  events.emplace_back(std::move(shape));
}

}  // namespace pixelflex::viewer
