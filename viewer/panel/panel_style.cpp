#include "viewer/panel/panel_style.h"

#include <imgui.h>

#include <array>
#include <filesystem>
#include <string>

namespace pixelflex::viewer {
namespace {

using Colours = PanelColours;

PanelFonts fonts;
float scaleNow = 1;

constexpr const char* kFolder = "/usr/share/fonts/truetype/dejavu/";
constexpr std::array<ImWchar, 15> kLetters = {0x20,   0x17F,  0x2010, 0x2026, 0x2070, 0x209F, 0x2190, 0x21FF,
                                              0x2200, 0x22FF, 0x2300, 0x23FF, 0x2500, 0x27BF, 0};

/// The toolkit's own font where DejaVu is missing.
ImFont* font(const char* file, float size) {
  ImFontAtlas* const atlas = ImGui::GetIO().Fonts;
  const std::string path = std::string(kFolder) + file;
  if (!std::filesystem::exists(path)) return atlas->AddFontDefault();
  return atlas->AddFontFromFileTTF(path.c_str(), size * scaleNow, nullptr, kLetters.data());
}

void loadFonts() {
  fonts.body = font("DejaVuSans.ttf", 14);
  fonts.strong = font("DejaVuSans-Bold.ttf", 14);
  fonts.title = font("DejaVuSans-Bold.ttf", 18);
  fonts.small = font("DejaVuSans.ttf", 12);
  fonts.fixed = font("DejaVuSansMono.ttf", 12);
}

void setColour(ImGuiCol which, std::uint32_t colour) {
  ImGui::GetStyle().Colors[which] = ImGui::ColorConvertU32ToFloat4(colour);
}

void setColours() {
  ImGui::StyleColorsDark();
  for (const int which : {ImGuiCol_Text, ImGuiCol_NavHighlight}) setColour(which, Colours::kText);
  setColour(ImGuiCol_NavHighlight, Colours::kAccent);
  setColour(ImGuiCol_TextDisabled, Colours::kDim);
  setColour(ImGuiCol_WindowBg, 0);  // the window is cleared with it
  setColour(ImGuiCol_ChildBg, Colours::kPane);
  setColour(ImGuiCol_PopupBg, Colours::kPane);
  for (const int which : {ImGuiCol_Border, ImGuiCol_Separator, ImGuiCol_TableBorderLight, ImGuiCol_TableBorderStrong}) {
    setColour(which, Colours::kLine);
  }
  for (const int which : {ImGuiCol_FrameBg, ImGuiCol_Button, ImGuiCol_TableHeaderBg})
    setColour(which, Colours::kRaised);
  for (const int which : {ImGuiCol_FrameBgHovered, ImGuiCol_FrameBgActive, ImGuiCol_ButtonHovered}) {
    setColour(which, Colours::kHover);
  }
  setColour(ImGuiCol_ButtonActive, Colours::kAccentDeep);
  setColour(ImGuiCol_CheckMark, Colours::kAccent);
  setColour(ImGuiCol_SliderGrab, 0);  // bars are filled up to their value
  setColour(ImGuiCol_SliderGrabActive, Colours::kAccent);
  setColour(ImGuiCol_Header, panelColour(0x3D8BFD, 70));
  setColour(ImGuiCol_HeaderHovered, panelColour(0x3D8BFD, 100));
  setColour(ImGuiCol_HeaderActive, panelColour(0x3D8BFD, 130));
  setColour(ImGuiCol_PlotHistogram, Colours::kAccent);
  setColour(ImGuiCol_Tab, Colours::kBack);
  setColour(ImGuiCol_TabHovered, Colours::kHover);
  setColour(ImGuiCol_TabActive, Colours::kAccentDeep);
  setColour(ImGuiCol_TabUnfocused, Colours::kBack);
  setColour(ImGuiCol_TabUnfocusedActive, Colours::kAccentDeep);
  setColour(ImGuiCol_ScrollbarBg, panelColour(0, 0));
  setColour(ImGuiCol_ScrollbarGrab, Colours::kHover);
}

void setDistances() {
  ImGuiStyle& style = ImGui::GetStyle();
  style = ImGuiStyle();
  style.WindowPadding = {10, 10};
  style.FramePadding = {8, 4};
  style.ItemSpacing = {8, 6};
  style.ItemInnerSpacing = {6, 4};
  style.CellPadding = {6, 3};
  style.WindowRounding = style.WindowBorderSize = 0;
  style.ChildRounding = 6;
  style.FrameRounding = style.PopupRounding = style.GrabRounding = style.TabRounding = 4;
  style.ScrollbarSize = 11;
  style.GrabMinSize = 5;
  style.ChildBorderSize = 0;
}

}  // namespace

void applyPanelStyle(float scale) {
  scaleNow = scale;
  setDistances();
  setColours();
  ImGui::GetStyle().ScaleAllSizes(scale);
  loadFonts();
}

const PanelFonts& panelFonts() {
  return fonts;
}

float panelScale() {
  return scaleNow;
}

std::uint32_t colourOfProjector(std::size_t index, std::uint32_t alpha) {
  constexpr std::array<std::uint32_t, 8> kColours = {0x5BA8F5, 0xF2A65A, 0x6CC788, 0xE58AC0,
                                                     0xB79CED, 0x4FC4CF, 0xE8D15C, 0xEF7F7A};
  return panelColour(kColours.at(index % kColours.size()), alpha);
}

}  // namespace pixelflex::viewer
