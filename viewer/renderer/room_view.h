#pragma once

#include <array>
#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

#include "devices/display/gl_context.h"
#include "devices/display/gl_handle.h"
#include "devices/display/gl_program.h"
#include "devices/image/image.h"
#include "viewer/tiles/box.h"

namespace pixelflex::viewer {

/// A projector pixel and where its light lands.
struct RoomVertex {
  float x = 0, y = 0;          // projector pixels
  float wallX = 0, wallY = 0;  // wall units
  float radiance = 1;          // light on the wall at full code, any unit that all projectors share
};

/// How one projector of a simulated wall lights it. Between vertices all is linear, so the mesh must be fine.
struct RoomMesh {
  devices::Size resolution;
  std::vector<RoomVertex> vertices;
  std::vector<std::uint32_t> indices;          // three a triangle
  std::array<std::vector<float>, 3> response;  // light for each of 256 codes, 1 at full; black leak at 0 included
};

/// Which part of the wall a picture of the room shows: the whole rectangle, as large as fits, centred.
struct RoomFraming {
  glm::dvec2 topLeft{0, 0};  // wall units
  glm::dvec2 bottomRight{1, 1};
  devices::Size picture;  // pixels
  bool operator==(const RoomFraming&) const = default;

  [[nodiscard]] double pixelsPerUnit() const;
  [[nodiscard]] glm::dvec2 pictureFromWall(glm::dvec2 pointInWall) const;
  [[nodiscard]] glm::dvec2 wallFromPicture(glm::dvec2 pixel) const;
};

/// The simulated wall as its audience sees it: every projector's frame where it lands, light added, shown in sRGB.
/// One thread, the context's.
class RoomView {
 public:
  /// The context must outlive the view and share textures with the projectors' renderer. Throws RendererError when a
  /// mesh is not sound.
  RoomView(devices::GlContext& context, const std::vector<RoomMesh>& projectors);
  ~RoomView();
  RoomView(const RoomView&) = delete;
  RoomView& operator=(const RoomView&) = delete;

  /// Room light on the wall, same unit as the radiance; the light that becomes white in the picture is 1 / exposure.
  void setLight(glm::vec3 ambient, float exposure);

  /// Draws the wall with these frames, one GL_TEXTURE_2D with row 0 at the top for each projector in order. `changed`:
  /// the projectors whose frames are others than in the last call; only where they shine is drawn again. The first time
  /// and with another framing or light all of it is.
  void draw(std::span<const devices::GlName> frames, std::span<const std::size_t> changed, const RoomFraming& framing);

  /// The picture drawn last: GL_TEXTURE_2D, row 0 at the top; of framing.picture. Valid until the next draw.
  [[nodiscard]] devices::GlName texture() const { return picture_.get(); }
  [[nodiscard]] devices::Image8 read();

 private:
  struct Projector {
    devices::GlBuffer vertices;
    devices::GlBuffer indices;
    devices::GlVertexArray vertexArray;
    devices::GlTexture response;
    devices::Size resolution;
    devices::GlTexture light;  // the frame as light, RGBA16F
    devices::GlFramebuffer lightTarget;
    int indexCount = 0;
    glm::dvec2 firstInWall{0, 0};  // box around all that it lights
    glm::dvec2 lastInWall{0, 0};
  };
  [[nodiscard]] static Projector makeProjector(const RoomMesh& mesh);
  void makeTargets(devices::Size size);
  [[nodiscard]] Box boxInPicture(const Projector& projector) const;
  void decode(const Projector& projector, devices::GlName frame) const;
  void addLight() const;
  void toneMap() const;

  devices::GlContext& context_;
  devices::GlProgram decodeProgram_;
  devices::GlProgram lightProgram_;
  devices::GlProgram toneProgram_;
  std::vector<Projector> projectors_;
  glm::vec3 ambient_{0, 0, 0};
  float exposure_ = 1;
  RoomFraming framing_;
  bool stale_ = true;  // everything has to be drawn
  devices::GlTexture light_;
  devices::GlFramebuffer lightTarget_;
  devices::GlTexture picture_;
  devices::GlFramebuffer pictureTarget_;
  devices::GlVertexArray noVertices_;
};

}  // namespace pixelflex::viewer
