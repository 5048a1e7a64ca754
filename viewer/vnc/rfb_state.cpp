#include "viewer/vnc/rfb_state.h"

#include <poll.h>
#include <rfb/rfbclient.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <new>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include "viewer/vnc/connector.h"
#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/jpeg_rect.h"
#include "viewer/vnc/rfb_messages.h"

// Exported, but in no header.
extern "C" void DefaultSupportedMessages(rfbClient* client);
extern "C" void ClearClient2Server(rfbClient* client, int message);

namespace pixelflex::viewer {
namespace {

// Its address names our data among a client's.
char clientDataTag = 0;

// Called through C, which no exception may cross. The bytes are ours to free.
rfbBool onJpeg(rfbClient* client, const std::uint8_t* bytes, int count, int x, int y, int width, int height) noexcept {
  JpegWorkers::Picture picture;
  picture.jpeg.reset(bytes);
  picture.bytes = static_cast<std::size_t>(count);
  auto& rfb = *static_cast<RfbState*>(rfbClientGetClientData(client, &clientDataTag));
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(rfb.pixelsSize.width);
  std::uint8_t* out =
      rfb.pixels.get() + static_cast<std::size_t>(y) * row + std::size_t{4} * static_cast<std::size_t>(x);
  if (std::int64_t{width} * height < JpegWorkers::kWorthwhilePixels) {
    if (decodeJpegRect({bytes, picture.bytes}, {width, height}, out, row)) return TRUE;
    rfbClientLog("a JPEG picture is damaged");
    return FALSE;
  }
  picture.box = {x, y, x + width, y + height};
  picture.out = out;
  picture.rowBytes = row;
  rfb.jpegWorkers.add(std::move(picture));
  return TRUE;
}

}  // namespace

RfbState::RfbState(int socket, const SessionOptions& sessionOptions)
    : options(sessionOptions), client(rfbGetClient(8, 3, 4)) {
  where = describeServer(options.server);
  if (client == nullptr) throw std::bad_alloc();
  client->sock = socket;
  client->GotJpeg = onJpeg;
  rfbClientSetClientData(client, &clientDataTag, this);
  // It asks for nothing by itself.
  DefaultSupportedMessages(client);
  ClearClient2Server(client, rfbFramebufferUpdateRequest);
}

RfbState::~RfbState() {
  client->sock = RFB_INVALID_SOCKET;  // neither is libvncclient's to close
  client->tlsSession = nullptr;
  rfbClientCleanup(client);
}

void RfbState::fail() const {
  throw streamFailure(where, insideUpdate, log);
}

void RfbState::refuse(const std::string& what) const {
  throw SessionError(CloseKind::kProtocol, where + " " + what);
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

void RfbState::giveBack(std::span<const std::uint8_t> bytes) {
  assert(bytes.size() + client->buffered <= givenBack_.size());
  std::memmove(&givenBack_[bytes.size()], client->bufoutptr, client->buffered);
  std::ranges::copy(bytes, givenBack_.begin());
  client->bufoutptr = reinterpret_cast<char*>(givenBack_.data());
  client->buffered += static_cast<unsigned>(bytes.size());
}

// Not through libvncclient, which would wait for ever for a server that takes nothing.
void RfbState::write(std::span<const std::uint8_t> message) const {
  while (!message.empty()) {
    const std::size_t sent = writeOnce(message);
    message = message.subspan(sent);
    if (sent > 0) continue;
    pollfd watched{client->sock, POLLOUT, 0};
    if (::poll(&watched, 1, static_cast<int>(options.patience.count())) == 0) {
      throw SessionError(CloseKind::kLost, where + " takes nothing more");
    }
  }
}

std::size_t RfbState::writeOnce(std::span<const std::uint8_t> bytes) const {
  if (tls == nullptr) {
    const ssize_t sent = ::send(client->sock, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (sent >= 0) return static_cast<std::size_t>(sent);
    if (errno == EAGAIN || errno == EINTR) return 0;
    throw SessionError(CloseKind::kLost,
                       "the connection to " + where + " broke: " + std::generic_category().message(errno));
  }
  try {
    return tls->write(bytes).bytes;
  } catch (const std::runtime_error& error) {
    throw SessionError(CloseKind::kLost, "the connection to " + where + " broke: " + error.what());
  }
}

void RfbState::finishPictures() {
  if (!jpegWorkers.finish()) refuse("sent a damaged update: a JPEG picture is damaged");
}

void RfbState::requestUpdate(bool incremental) const {
  write(updateRequestMessage(incremental, pixelsSize));
}

void RfbState::enableContinuousUpdates() {
  continuousUpdates = true;
  write(continuousUpdatesMessage(pixelsSize));
}

void RfbState::resize(devices::Size size) {
  const std::string extent = std::to_string(size.width) + "x" + std::to_string(size.height);
  if (size.width <= 0 || size.height <= 0) refuse("announces a desktop of " + extent + " pixels");
  if (size.width > kMaxDesktopExtent || size.height > kMaxDesktopExtent) {
    const std::string most = std::to_string(kMaxDesktopExtent);
    throw SessionError(CloseKind::kTooLarge, "the server's desktop is " + extent + "; at most " + most + "x" + most +
                                                 " is supported; start it with a smaller -geometry");
  }
  const bool first = pixels == nullptr;
  if (!first && size == pixelsSize) return;
  finishPictures();
  // Pages that nothing was written to take no memory: calloc maps them on demand.
  Pixels fresh(static_cast<std::uint8_t*>(std::calloc(static_cast<std::size_t>(size.area()), 4)));
  if (fresh == nullptr) {
    throw SessionError(CloseKind::kTooLarge, "not enough memory for the server's desktop of " + extent);
  }
  adopt(std::move(fresh), size);
  if (first) return;
  damage.add(boxOf(size));
  appendEvent(events, Resized{size});
}

void RfbState::adopt(Pixels fresh, devices::Size size) {
  const auto rowBytes = [](int width) { return std::size_t{4} * static_cast<std::size_t>(width); };
  const int commonHeight = std::min(size.height, pixelsSize.height);
  for (std::size_t y = 0; y < static_cast<std::size_t>(commonHeight); ++y) {
    std::memcpy(fresh.get() + y * rowBytes(size.width), pixels.get() + y * rowBytes(pixelsSize.width),
                rowBytes(std::min(size.width, pixelsSize.width)));
  }
  pixels = std::move(fresh);
  pixelsSize = size;
  client->width = size.width;
  client->height = size.height;
  client->updateRect = {0, 0, size.width, size.height};
  client->frameBuffer = pixels.get();
  firstPixel.reset();
  damage.clear();
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

}  // namespace pixelflex::viewer
