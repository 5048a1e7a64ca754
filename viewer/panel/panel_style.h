#pragma once

#include <cstdint>

struct ImFont;

namespace pixelflex::viewer {

/// Fonts of the panel; they live as long as its window.
struct PanelFonts {
  ImFont* body = nullptr;
  ImFont* strong = nullptr;
  ImFont* title = nullptr;
  ImFont* small = nullptr;
  ImFont* fixed = nullptr;
};

/// 0xRRGGBB in the toolkit's order.
constexpr std::uint32_t panelColour(std::uint32_t rgb, std::uint32_t alpha = 255) {
  return (alpha << 24U) | ((rgb & 0xFFU) << 16U) | (rgb & 0xFF00U) | (rgb >> 16U);
}

struct PanelColours {
  static constexpr std::uint32_t kBack = panelColour(0x14181D);
  static constexpr std::uint32_t kPane = panelColour(0x1C2128);
  static constexpr std::uint32_t kRaised = panelColour(0x2A313B);
  static constexpr std::uint32_t kHover = panelColour(0x36404D);
  static constexpr std::uint32_t kLine = panelColour(0x333C47);
  static constexpr std::uint32_t kText = panelColour(0xE6EAF0);
  static constexpr std::uint32_t kDim = panelColour(0x93A0B0);
  static constexpr std::uint32_t kAccent = panelColour(0x3D8BFD);
  static constexpr std::uint32_t kAccentDeep = panelColour(0x24569E);
  static constexpr std::uint32_t kGood = panelColour(0x4CC38A);
  static constexpr std::uint32_t kWarn = panelColour(0xF0B429);
  static constexpr std::uint32_t kBad = panelColour(0xFF6B6B);
  static constexpr std::uint32_t kStop = panelColour(0xC8232C);
  static constexpr std::uint32_t kStopHover = panelColour(0xE5383B);
};

/// Colours, distances and fonts of the toolkit's current context.
void applyPanelStyle(float scale);
[[nodiscard]] const PanelFonts& panelFonts();
/// Of all distances in the panel's code.
[[nodiscard]] float panelScale();

/// A projector's colour on the map and in the lists.
[[nodiscard]] std::uint32_t colourOfProjector(std::size_t index, std::uint32_t alpha = 255);

}  // namespace pixelflex::viewer
