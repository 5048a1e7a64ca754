#include "viewer/vnc/rfb_client.h"

#include <rfb/rfbclient.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>
#include <utility>

#include "viewer/vnc/event_queue.h"
#include "viewer/vnc/rfb_clipboard.h"
#include "viewer/vnc/rfb_handshake.h"
#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/rfb_resize.h"
#include "viewer/vnc/rfb_state.h"
#include "viewer/vnc/rfb_update.h"
#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {
namespace {

enum ServerMessage : std::uint8_t {
  kFramebufferUpdate = 0,
  kSetColourMapEntries = 1,
  kBell = 2,
  kServerCutText = 3,
  kEndOfContinuousUpdates = 150,
  kFence = 248,
};

constexpr std::size_t kMaxFenceBytes = 64;  // as the protocol has it
constexpr std::uint32_t kFenceRequest = 1u << 31;
constexpr std::uint32_t kFenceBlocks = 3;  // the flags that a client like this one, which does one thing at a time, has

// libvncclient goes on from here, as if the handshake had been its own.
void adopt(RfbState& rfb, Handshake handshake) {
  rfb.desktopName = utf8FromEither(handshake.desktopName);
  rfb.security = std::move(handshake.security);
  rfb.tls = std::move(handshake.tls);
  if (rfb.tls != nullptr) rfb.client->tlsSession = rfb.tls->handle();
  rfb.resize(handshake.desktop);
}

void sendEncodings(const RfbState& rfb) {
  rfb.write(setEncodingsMessage(
      {.link = rfb.link, .mayResize = rfb.options.mayResize, .clipboard = rfb.options.clipboardLimit > 0}));
}

void requestFirstPicture(RfbState& rfb) {
  rfb.write(setPixelFormatMessage());
  sendEncodings(rfb);
  rfb.requestUpdate(false);
}

// A server that has this message sends it once to say that it can send updates unasked.
void useContinuousUpdates(RfbState& rfb) {
  if (!rfb.continuousUpdates) rfb.enableContinuousUpdates();
}

void noteAnswer(RfbState& rfb) {
  if (!rfb.pinged) return;
  const auto time = std::chrono::steady_clock::now() - *std::exchange(rfb.pinged, std::nullopt);
  rfb.roundTrip = std::min(rfb.roundTrip.value_or(time), std::chrono::nanoseconds(time));
}

// The server measures how far behind this side is. Whatever came before was decoded by now.
void answerFence(RfbState& rfb) {
  std::array<std::uint8_t, 8> head{};  // padding, flags, length
  rfb.read(head);
  const std::uint32_t flags = bigEndian(std::span(head).subspan(3, 4));
  std::vector<std::uint8_t> payload(head.back());
  if (payload.size() > kMaxFenceBytes) rfb.refuse("sent a fence that is too long");
  rfb.read(payload);
  rfb.hasFences = true;
  if ((flags & kFenceRequest) == 0) return noteAnswer(rfb);
  rfb.write(fenceMessage(flags & kFenceBlocks, payload));
}

// Colour maps mean nothing to a true-colour rfb.client, but their bytes must go.
void skipColourMap(RfbState& rfb) {
  std::array<std::uint8_t, 5> header{};
  rfb.read(header);
  rfb.discard(std::uint64_t{6} * bigEndian(std::span(header).last(2)));
}

}  // namespace

RfbClient::RfbClient(int socket, const SessionOptions& options, const LinkSettings& link)
    : state_(std::make_unique<RfbState>(socket, options)) {
  state_->link = link;
}

RfbClient::~RfbClient() = default;

void RfbClient::handshake(Deadline deadline, const Signal& stop) {
  adopt(*state_, shakeHands(state_->client->sock, state_->options, deadline, stop));
  state_->limitReading();
  requestFirstPicture(*state_);
}

std::string RfbClient::desktopName() const {
  return state_->desktopName;
}

const ConnectionSecurity& RfbClient::security() const {
  return state_->security;
}

devices::Size RfbClient::desktop() const {
  return state_->pixelsSize;
}

bool RfbClient::hasBufferedBytes() const {
  return state_->client->buffered > 0 || (state_->tls != nullptr && state_->tls->hasPendingBytes());
}

void RfbClient::handleMessage() {
  state_->log.clear();
  std::uint8_t type = 0;
  state_->read({&type, 1});
  switch (type) {
    case kFramebufferUpdate:
      return readUpdate(*state_);
    case kSetColourMapEntries:
      return skipColourMap(*state_);
    case kBell:
      appendEvent(state_->events, Bell{});
      return;
    case kServerCutText:
      return readClipboard(*state_);
    case kEndOfContinuousUpdates:
      return useContinuousUpdates(*state_);
    case kFence:
      return answerFence(*state_);
    default:
      state_->refuse("sent a message of unknown type " + std::to_string(type) + " that was not asked for");
  }
}

std::vector<SessionEvent> RfbClient::takeEvents() {
  return std::exchange(state_->events, {});
}

std::optional<Region> RfbClient::takeFinishedUpdate() {
  if (!std::exchange(state_->updateFinished, false)) return std::nullopt;
  if (state_->isOnlySignOfLife()) state_->damage.clear();
  return std::exchange(state_->damage, {});
}

FrameView RfbClient::frame() const {
  const auto bytes = std::size_t{4} * static_cast<std::size_t>(state_->pixelsSize.area());
  return {std::as_bytes(std::span(state_->pixels.get(), bytes)), state_->pixelsSize};
}

void RfbClient::send(const Input& input) {
  const devices::Size desktop = state_->pixelsSize;
  if (const auto* pointer = std::get_if<PointerInput>(&input)) {
    state_->pointerUsed = true;
    state_->write(pointerMessage(std::clamp(pointer->x, 0, desktop.width - 1),
                                 std::clamp(pointer->y, 0, desktop.height - 1), pointer->buttons,
                                 state_->extendedButtons));
  } else if (const auto* key = std::get_if<KeyInput>(&input)) {
    state_->write(keyMessage(key->keysym, key->down));
  } else if (const auto* clipboard = std::get_if<ClipboardInput>(&input)) {
    offerClipboard(*state_, clipboard->text);
  } else if (const auto* layout = std::get_if<LayoutInput>(&input)) {
    state_->wantedLayout = layout->layout;
    requestWantedLayout(*state_);
  }
}

void RfbClient::setLink(const LinkSettings& link) {
  state_->link = link;
  sendEncodings(*state_);
}

bool RfbClient::ping() {
  if (!state_->hasFences || state_->pinged) return false;
  state_->pinged = std::chrono::steady_clock::now();
  state_->write(fenceMessage(kFenceRequest, {}));
  return true;
}

std::optional<std::chrono::nanoseconds> RfbClient::roundTrip() const {
  return state_->roundTrip;
}

void RfbClient::askForSignOfLife() {
  state_->write(updateRequestMessage(false, {1, 1}));
}

void RfbClient::giveUp() const {
  throw SessionError(CloseKind::kLost, state_->where + " does not answer any more");
}

// Asking for the encodings once more makes the server remove what it has drawn.
void RfbClient::claimPointer() {
  if (!state_->pointerDrawn || state_->pointerUsed) return;
  send(PointerInput{state_->pixelsSize.width / 2, state_->pixelsSize.height / 2, 0});
  sendEncodings(*state_);
}

}  // namespace pixelflex::viewer
