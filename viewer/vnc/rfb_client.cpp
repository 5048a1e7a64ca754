#include "viewer/vnc/rfb_client.h"

#include <poll.h>
#include <rfb/rfbclient.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <span>
#include <utility>

#include "viewer/vnc/connector.h"
#include "viewer/vnc/handshake_watch.h"
#include "viewer/vnc/rfb_cursor.h"
#include "viewer/vnc/rfb_failure.h"
#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/text_encoding.h"

// libvncclient's own JPEG decoder; exported, but in no header.
extern "C" int tjDestroy(void* decoder);

namespace pixelflex::viewer {
namespace {

constexpr std::size_t kGreetingBytes = 12;
constexpr std::uint32_t kMaxClipboardBytes = 1u << 20;      // from the server
constexpr std::size_t kMaxSentClipboardBytes = 256u << 10;  // what TigerVNC's server accepts
constexpr int kMaxCursorExtent = 1024;

enum ServerMessage : std::uint8_t { kFramebufferUpdate = 0, kSetColourMapEntries = 1, kBell = 2, kServerCutText = 3 };

struct Free {
  void operator()(void* memory) const { std::free(memory); }
};

std::uint32_t bigEndian(std::span<const std::uint8_t> bytes) {
  std::uint32_t value = 0;
  for (const std::uint8_t byte : bytes) value = value << 8 | byte;
  return value;
}

devices::Size sizeOf(const rfbClient& client) {
  return {client.width, client.height};
}

}  // namespace

// libvncclient calls back through C, which no exception may cross: the callbacks note what happened, and the calls
// around them throw.
struct RfbClient::State {
  State(int socket, const SessionOptions& options);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void greet(Deadline deadline, const Signal& stop);
  void initialise(Deadline deadline);
  void requestFirstPicture();
  void read(std::span<std::uint8_t> bytes);
  void discard(std::uint64_t count);
  void write(std::span<const std::uint8_t> message);
  void readUpdate();
  void readClipboard();
  void skipColourMap();
  void readAlphaCursor(devices::Size size, int hotX, int hotY);
  [[noreturn]] void fail() const;
  bool allocate() noexcept;

  static State& of(rfbClient* client);
  static char* onPassword(rfbClient* client) noexcept;
  static rfbBool onMalloc(rfbClient* client) noexcept { return of(client).allocate() ? TRUE : FALSE; }
  static void onRect(rfbClient* client, int x, int y, int w, int h) noexcept;
  static void onFinished(rfbClient* client) noexcept { of(client).updateFinished = true; }
  static void onCursor(rfbClient* client, int hotX, int hotY, int width, int height, int bytesPerPixel) noexcept;
  static rfbBool onPointer(rfbClient* client, int x, int y) noexcept;
  static rfbBool onEncoding(rfbClient* client, rfbFramebufferUpdateRectHeader* rect) noexcept;
  static void registerEncodings();

  RfbLog log;
  const SessionOptions& options;
  HandshakeState handshake;
  rfbClient* client = nullptr;
  std::unique_ptr<std::uint8_t, Free> pixels;
  devices::Size pixelsSize;
  Region damage;
  bool insideUpdate = false;
  bool updateFinished = false;
  bool pointerUsed = false;   // this session has put it somewhere
  bool pointerDrawn = false;  // by the server, into the desktop
  bool pseudoRect = false;    // the next rectangle reported is none
  std::optional<SessionError> failure;
  std::vector<SessionEvent> events;
};

namespace {

// Its address names our data among a client's.
char clientDataTag = 0;

}  // namespace

RfbClient::State::State(int socket, const SessionOptions& sessionOptions) : options(sessionOptions) {
  registerEncodings();
  handshake.where = describeServer(options.server);
  client = rfbGetClient(8, 3, 4);
  if (client == nullptr) throw std::bad_alloc();
  rfbClientSetClientData(client, &clientDataTag, this);
  client->sock = socket;
  client->appData.shareDesktop = options.shared ? TRUE : FALSE;
  client->GetPassword = onPassword;
  client->MallocFrameBuffer = onMalloc;
  client->GotFrameBufferUpdate = onRect;
  client->FinishedFrameBufferUpdate = onFinished;
  client->GotCursorShape = onCursor;
  client->HandleCursorPos = onPointer;
  const std::array<std::uint32_t, 2> securityTypes{rfbNoAuth, rfbVncAuth};
  SetClientAuthSchemes(client, securityTypes.data(), static_cast<int>(securityTypes.size()));
}

RfbClient::State::~State() {
  std::free(client->rcSource);
  std::free(client->rcMask);
  if (client->tjhnd != nullptr) tjDestroy(client->tjhnd);  // nobody else does
  client->sock = RFB_INVALID_SOCKET;                       // not libvncclient's to close
  rfbClientCleanup(client);
}

RfbClient::State& RfbClient::State::of(rfbClient* client) {
  return *static_cast<State*>(rfbClientGetClientData(client, &clientDataTag));
}

void RfbClient::State::fail() const {
  if (failure) throw *failure;
  throw streamFailure(handshake.where, insideUpdate, log);
}

void RfbClient::State::read(std::span<std::uint8_t> bytes) {
  if (bytes.empty()) return;  // libvncclient takes no null pointer, not even for no bytes
  if (!ReadFromRFBServer(client, reinterpret_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()))) fail();
}

void RfbClient::State::discard(std::uint64_t count) {
  std::array<std::uint8_t, 4096> bin{};
  while (count > 0) {
    const std::size_t part = std::min<std::uint64_t>(count, bin.size());
    read(std::span(bin).first(part));
    count -= part;
  }
}

void RfbClient::State::write(std::span<const std::uint8_t> message) {
  if (!WriteToRFBServer(client, reinterpret_cast<const char*>(message.data()), static_cast<unsigned>(message.size()))) {
    fail();
  }
}

// The greeting is read here, because libvncclient would wait for ever for the twelfth byte of something else, and given
// back as if it had not been read.
void RfbClient::State::greet(Deadline deadline, const Signal& stop) {
  std::string greeting;
  while (greeting.size() < kGreetingBytes) {
    if (!waitFor(client->sock, POLLIN, deadline, stop)) {
      throw SessionError(CloseKind::kNotVnc,
                         handshake.where + " accepts connections but says nothing: is it a VNC server?");
    }
    std::array<char, kGreetingBytes> part{};
    const ssize_t got = ::recv(client->sock, part.data(), kGreetingBytes - greeting.size(), 0);
    if (got <= 0) {
      throw SessionError(CloseKind::kLost, handshake.where + " closed the connection during the handshake");
    }
    greeting.append(part.data(), static_cast<std::size_t>(got));
    if (!greeting.starts_with(std::string_view("RFB ").substr(0, greeting.size()))) {
      throw notVnc(handshake.where, greeting);
    }
  }
  std::memcpy(client->buf, greeting.data(), greeting.size());
  client->bufoutptr = client->buf;
  client->buffered = static_cast<unsigned>(greeting.size());
}

void RfbClient::State::initialise(Deadline deadline) {
  const HandshakeWatch watch(client->sock, deadline);
  const bool agreed = InitialiseRFBConnection(client) != FALSE;
  handshake.timedOut = watch.expired();
  if (!agreed || handshake.timedOut) throw handshakeFailure(handshake, log);
}

void RfbClient::State::requestFirstPicture() {
  client->width = client->si.framebufferWidth;
  client->height = client->si.framebufferHeight;
  client->updateRect = {0, 0, client->width, client->height};
  if (!allocate()) fail();
  write(setPixelFormatMessage());
  write(setEncodingsMessage(options.lossless));
  if (!SendFramebufferUpdateRequest(client, 0, 0, client->width, client->height, FALSE)) fail();
}

// Gives libvncclient a frame buffer of its present size. What was shown stays shown until the server has sent the new
// picture. Pages that nothing was written to take no memory: calloc maps them on demand.
bool RfbClient::State::allocate() noexcept {
  const devices::Size size = sizeOf(*client);
  const std::string extent = std::to_string(size.width) + "x" + std::to_string(size.height);
  if (size.width <= 0 || size.height <= 0) {
    failure = SessionError(CloseKind::kProtocol, handshake.where + " announces a desktop of " + extent + " pixels");
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
  damage.clear();
  if (changed) {
    damage.add(boxOf(size));
    events.emplace_back(Resized{size});
  }
  return true;
}

char* RfbClient::State::onPassword(rfbClient* client) noexcept {
  State& state = of(client);
  state.handshake.passwordAsked = true;
  state.handshake.passwordGiven = state.options.password.has_value() && !state.options.password->empty();
  return state.handshake.passwordGiven ? ::strdup(state.options.password->c_str()) : nullptr;
}

void RfbClient::State::onRect(rfbClient* client, int x, int y, int w, int h) noexcept {
  State& state = of(client);
  if (std::exchange(state.pseudoRect, false)) return;
  state.damage.add(intersect({x, y, x + w, y + h}, boxOf(state.pixelsSize)));
}

void RfbClient::State::onCursor(rfbClient* client, int hotX, int hotY, int width, int height, int) noexcept {
  const devices::Size size{width, height};
  const auto area = static_cast<std::size_t>(size.area());
  CursorShape shape = cursorFromMask(size, {client->rcSource, 4 * area}, {client->rcMask, area});
  shape.hotX = hotX;
  shape.hotY = hotY;
  of(client).events.emplace_back(std::move(shape));
  // libvncclient allocates a new mask for each cursor and forgets the old one.
  std::free(std::exchange(client->rcMask, nullptr));
}

rfbBool RfbClient::State::onPointer(rfbClient* client, int x, int y) noexcept {
  of(client).events.emplace_back(CursorMoved{x, y});
  return TRUE;
}

void RfbClient::State::readAlphaCursor(devices::Size size, int hotX, int hotY) {
  std::array<std::uint8_t, 4> encoding{};
  read(encoding);
  if (bigEndian(encoding) != 0 || size.width > kMaxCursorExtent || size.height > kMaxCursorExtent) {
    throw SessionError(CloseKind::kProtocol, handshake.where + " sent a pointer shape that cannot be read");
  }
  std::vector<std::uint8_t> rgba(4 * static_cast<std::size_t>(size.area()));
  read(rgba);
  CursorShape shape = cursorFromPremultiplied(size, rgba);
  pointerDrawn = size.area() == 0;  // or the pointer is hidden, which looks the same
  shape.hotX = hotX;
  shape.hotY = hotY;
  events.emplace_back(std::move(shape));
}

rfbBool RfbClient::State::onEncoding(rfbClient* client, rfbFramebufferUpdateRectHeader* rect) noexcept {
  State& state = of(client);
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

void RfbClient::State::registerEncodings() {
  static std::array<int, 3> encodings{kCursorWithAlphaEncoding, kVmwareCursorPositionEncoding, 0};
  static rfbClientProtocolExtension extension{encodings.data(), onEncoding, nullptr, nullptr, nullptr, nullptr};
  static std::once_flag once;
  std::call_once(once, [] { rfbClientRegisterExtension(&extension); });
}

void RfbClient::State::readUpdate() {
  // The type byte goes back to where libvncclient took it from: it reads the whole message itself.
  --client->bufoutptr;
  ++client->buffered;
  insideUpdate = true;
  if (!HandleRFBServerMessage(client)) fail();
  insideUpdate = false;
  if (log.damaged())
    throw SessionError(CloseKind::kProtocol, handshake.where + " sent a damaged update: " + log.last());
}

// libvncclient would end the session over a text beyond its limit; here such a text is left out.
void RfbClient::State::readClipboard() {
  std::array<std::uint8_t, 7> header{};
  read(header);
  const std::uint32_t length = bigEndian(std::span(header).last(4));
  if (length > kMaxClipboardBytes) {
    discard(length);
    return;
  }
  std::string text(length, '\0');
  read({reinterpret_cast<std::uint8_t*>(text.data()), text.size()});
  events.emplace_back(Clipboard{utf8FromLatin1(text)});
}

// Colour maps mean nothing to a true-colour client, but their bytes must go.
void RfbClient::State::skipColourMap() {
  std::array<std::uint8_t, 5> header{};
  read(header);
  discard(std::uint64_t{6} * bigEndian(std::span(header).last(2)));
}

RfbClient::RfbClient(int socket, const SessionOptions& options) : state_(std::make_unique<State>(socket, options)) {}

RfbClient::~RfbClient() = default;

void RfbClient::handshake(Deadline deadline, const Signal& stop) {
  state_->greet(deadline, stop);
  state_->initialise(deadline);
  state_->requestFirstPicture();
}

std::string RfbClient::desktopName() const {
  return utf8FromEither(state_->client->desktopName);
}

devices::Size RfbClient::desktop() const {
  return state_->pixelsSize;
}

bool RfbClient::hasBufferedBytes() const {
  return state_->client->buffered > 0;
}

void RfbClient::handleMessage() {
  state_->log.clear();
  std::uint8_t type = 0;
  state_->read({&type, 1});
  switch (type) {
    case kFramebufferUpdate:
      return state_->readUpdate();
    case kSetColourMapEntries:
      return state_->skipColourMap();
    case kBell:
      state_->events.emplace_back(Bell{});
      return;
    case kServerCutText:
      return state_->readClipboard();
    default:
      throw SessionError(CloseKind::kProtocol, state_->handshake.where + " sent a message of unknown type " +
                                                   std::to_string(type) + " that was not asked for");
  }
}

std::vector<SessionEvent> RfbClient::takeEvents() {
  return std::exchange(state_->events, {});
}

std::optional<Region> RfbClient::takeFinishedUpdate() {
  if (!std::exchange(state_->updateFinished, false)) return std::nullopt;
  return std::exchange(state_->damage, {});
}

FrameView RfbClient::frame() const {
  const auto bytes = std::size_t{4} * static_cast<std::size_t>(state_->pixelsSize.area());
  return {std::as_bytes(std::span(state_->pixels.get(), bytes)), state_->pixelsSize};
}

void RfbClient::send(const Input& input) {
  rfbClient* client = state_->client;
  bool sent = true;
  state_->pointerUsed |= std::holds_alternative<PointerInput>(input);
  if (const auto* pointer = std::get_if<PointerInput>(&input)) {
    sent = SendPointerEvent(client, std::clamp(pointer->x, 0, client->width - 1),
                            std::clamp(pointer->y, 0, client->height - 1), pointer->buttons);
  } else if (const auto* key = std::get_if<KeyInput>(&input)) {
    sent = SendKeyEvent(client, key->keysym, key->down ? TRUE : FALSE);
  } else if (const auto* clipboard = std::get_if<ClipboardInput>(&input)) {
    std::string text = latin1FromUtf8(clipboard->text);
    text.resize(std::min(text.size(), kMaxSentClipboardBytes));
    sent = SendClientCutText(client, text.data(), static_cast<int>(text.size()));
  }
  if (!sent) state_->fail();
}

// Asking for the encodings once more makes the server remove what it has drawn.
void RfbClient::claimPointer() {
  if (!state_->pointerDrawn || state_->pointerUsed) return;
  send(PointerInput{state_->pixelsSize.width / 2, state_->pixelsSize.height / 2, 0});
  state_->write(setEncodingsMessage(state_->options.lossless));
}

}  // namespace pixelflex::viewer
