// The Extended Clipboard as servers and clients speak it, and buttons beyond the seventh.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <chrono>

#include "tests/support/desktop_mirror.h"
#include "tests/support/fake_vnc_server.h"
#include "viewer/vnc/clipboard_messages.h"
#include "viewer/vnc/rfb_messages.h"
#include "viewer/vnc/text_encoding.h"

namespace pixelflex::viewer {
namespace {

using pixelflex::testing::DesktopMirror;
using pixelflex::testing::FakeConnection;
using pixelflex::testing::FakeVncServer;
using pixelflex::testing::Message;
using ::testing::ElementsAre;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint32_t kAll =
    kClipboardCaps | kClipboardRequest | kClipboardPeek | kClipboardNotify | kClipboardProvide | kClipboardText;

Bytes packed(const Bytes& plain) {
  uLongf size = compressBound(plain.size());
  Bytes bytes(size);
  EXPECT_EQ(compress(bytes.data(), &size, plain.data(), plain.size()), Z_OK);
  bytes.resize(size);
  return bytes;
}

Bytes unpacked(std::span<const std::uint8_t> bytes, std::size_t most) {
  Bytes plain(most);
  uLongf size = most;
  EXPECT_EQ(uncompress(plain.data(), &size, bytes.data(), bytes.size()), Z_OK);
  plain.resize(size);
  return plain;
}

Bytes sizedText(const std::string& text) {
  Bytes bytes;
  appendNumber(bytes, static_cast<std::uint32_t>(text.size()), 4);
  bytes.insert(bytes.end(), text.begin(), text.end());
  return bytes;
}

/// Server to client: an extended cut text.
Message extended(std::uint32_t flags, const Bytes& payload) {
  Message message;
  message.u8(3).repeat(0, 3).s32(-4 - static_cast<std::int32_t>(payload.size())).u32(flags);
  for (const std::uint8_t byte : payload) message.u8(byte);
  return message;
}

struct Received {
  std::uint32_t flags = 0;
  Bytes payload;
};

/// The client's next extended cut text; it must be one.
Received receiveExtended(const FakeConnection& client) {
  const Bytes head = client.receive(12);
  EXPECT_EQ(head.front(), 6);
  const auto length = static_cast<std::int32_t>(bigEndian(std::span(head).subspan(4, 4)));
  EXPECT_LE(length, -4);
  return {bigEndian(std::span(head).last(4)), client.receive(static_cast<std::size_t>(-length - 4))};
}

TEST(LineEnds, AreCrLfOnTheLinkAndPlainHere) {
  EXPECT_EQ(withCrLf("a\nb\r\nc\rd\n"), "a\r\nb\r\nc\r\nd\r\n");
  EXPECT_EQ(withPlainLineEnds("a\r\nb\rc\n\r\n"), "a\nb\nc\n\n");
}

TEST(ClipboardMessages, ProvideATextPackedWithItsSizeAndAnEnd) {
  const Bytes message = clipboardProvideMessage("ä\n€");
  EXPECT_EQ(message[0], 6);
  EXPECT_EQ(bigEndian(std::span(message).subspan(8, 4)), kClipboardProvide | kClipboardText);
  EXPECT_EQ(static_cast<std::int32_t>(bigEndian(std::span(message).subspan(4, 4))),
            8 - static_cast<std::int32_t>(message.size()));
  EXPECT_EQ(unpacked(std::span(message).subspan(12), 100), sizedText(std::string("ä\r\n€\0", 8)));
}

TEST(ClipboardMessages, AreParsedWithinTheirBounds) {
  const std::uint32_t flags = kClipboardProvide | kClipboardText;
  const Bytes good = packed(sizedText(std::string("ä\r\n€\0", 8)));
  EXPECT_EQ(parseProvidedText(flags, good, 8), "ä\n€");
  EXPECT_FALSE(parseProvidedText(flags, good, 7)) << "beyond the limit";
  EXPECT_FALSE(parseProvidedText(kClipboardProvide | 2, good, 100)) << "another format";
  for (std::size_t length = 0; length + 5 < good.size(); ++length) {
    EXPECT_FALSE(parseProvidedText(flags, std::span(good).first(length), 100)) << length;
  }
  EXPECT_FALSE(parseProvidedText(flags, packed({0, 0, 0, 50, 'x'}), 100)) << "shorter than it says";
  EXPECT_FALSE(parseProvidedText(flags, Bytes(64, 0xab), 100)) << "not packed";
  EXPECT_EQ(parseClipboardCaps(kAll, Bytes{0, 1, 0, 0}), (ClipboardCaps{kAll, 65536}));
  EXPECT_EQ(parseClipboardCaps(kAll, Bytes{}), (ClipboardCaps{kAll, 0}));
}

TEST(ExtendedClipboard, FetchesWhatTheServerTellsOf) {
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({8, 8});
    client.send(extended(kAll, {0, 0, 0, 0}));
    EXPECT_EQ(receiveExtended(client).flags, kAll);
    client.send(extended(kClipboardNotify | kClipboardText, {}));
    EXPECT_EQ(receiveExtended(client).flags, kClipboardRequest | kClipboardText);
    client.send(extended(kClipboardProvide | kClipboardText, packed(sizedText(std::string("ä\r\n→\0", 8)))));
    client.drain(std::chrono::seconds(20));
  });
  DesktopMirror mirror(server.address());
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Clipboard>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Clipboard>(), Clipboard{"ä\n→"});
}

TEST(ExtendedClipboard, TellsOfATextAndProvidesItWhenAsked) {
  Received offer, peeked, provided;
  const auto script = [&](FakeConnection& client) {
    client.shakeHands({8, 8});
    client.send(extended(kAll, {0, 0, 0, 0}).u8(2));
    (void)receiveExtended(client);  // what the client can do
    offer = receiveExtended(client);
    client.send(extended(kClipboardPeek, {}));
    peeked = receiveExtended(client);
    client.send(extended(kClipboardRequest | kClipboardText, {}));
    provided = receiveExtended(client);
  };
  {
    const FakeVncServer server(script);
    DesktopMirror mirror(server.address());
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
    mirror.session().sendClipboard("→ line\n");
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  }
  EXPECT_EQ(offer.flags, kClipboardNotify | kClipboardText);
  EXPECT_EQ(peeked.flags, kClipboardNotify | kClipboardText);
  EXPECT_EQ(provided.flags, kClipboardProvide | kClipboardText);
  EXPECT_EQ(unpacked(provided.payload, 100), sizedText(std::string("→ line\r\n\0", 11)));
}

TEST(ExtendedClipboard, LeavesOutWhatIsTooLong) {
  const FakeVncServer server([](FakeConnection& client) {
    client.shakeHands({8, 8});
    client.send(extended(kAll, {0, 0, 0, 0}));
    (void)receiveExtended(client);
    const std::uint32_t provide = kClipboardProvide | kClipboardText;
    client.send(extended(provide, packed(sizedText(std::string(200'000, 'x')))));  // small until it is unpacked
    client.send(extended(provide, Bytes(300'000, 7)));                             // large as it is
    client.send(extended(provide, packed(sizedText("short"))).u8(2));
    client.drain(std::chrono::seconds(20));
  });
  SessionOptions options;
  options.server = parseServerAddress(server.address());
  options.clipboardLimit = 100'000;
  DesktopMirror mirror(options);
  EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
  EXPECT_EQ(mirror.last<Clipboard>(), Clipboard{"short"});
  EXPECT_EQ(mirror.last<ClipboardRefused>(), (ClipboardRefused{true, 100'000}));
}

TEST(Pointer, SendsSideButtonsToServersThatTakeThem) {
  Bytes pressed;
  {
    const FakeVncServer server([&](FakeConnection& client) {
      client.shakeHands({300, 200});
      client.send(Message().update(1).rect(0, 0, 0, 0, kExtendedMouseButtonsEncoding).u8(2));
      pressed = client.receive(10 + 7);  // a request for the next update comes first
    });
    DesktopMirror mirror(server.address());
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Bell>().has_value(); })) << mirror.summary();
    mirror.session().sendPointer(9, 8, 1u << 8 | 1u);
    EXPECT_TRUE(mirror.pumpUntil([&] { return mirror.last<Closed>().has_value(); })) << mirror.summary();
  }
  ASSERT_EQ(pressed.size(), 17u);
  EXPECT_THAT(Bytes(pressed.begin() + 10, pressed.end()), ElementsAre(5, 0x81, 0, 9, 0, 8, 2));
  EXPECT_THAT(pointerMessage(9, 8, 1u << 8 | 1u, false), ElementsAre(5, 1, 0, 9, 0, 8));
}

}  // namespace
}  // namespace pixelflex::viewer
