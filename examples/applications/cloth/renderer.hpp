// SPDX-License-Identifier: MIT
//
// Draws a cloth and what it touches, lit and shadowed, in the GL context that is current. The cloth's points come as two
// buffers of the context, which a device or the host has filled; it knows nothing of either.
#pragma once

#include <vector>

#include "camera.hpp"
#include "model.hpp"
#include "scene.hpp"
#include "support/gl_objects.hpp"
#include "support/image.hpp"

namespace examples {

/// Four floats for each point: positions, and normals with the bits of whole triangles.
struct ClothBuffers {
  GLuint positions = 0;
  GLuint normals = 0;
};

class Renderer {
 public:
  /// Throws std::runtime_error where the context has no OpenGL 3.3.
  Renderer(const Scene& scene, const ClothBuffers& cloth);

  /// Draws to the framebuffer `target`, of this size, with factor x factor samples a pixel. `bodies` are their places.
  void draw(const Orbit& camera, const std::vector<Placed>& bodies, int width, int height, int factor,
            GLuint target);
  /// The same to a picture.
  Image picture(const Orbit& camera, const std::vector<Placed>& bodies, int width, int height, int factor);

 private:
  struct BodyMesh {
    GlVertexArray array;
    GlBuffer vertices, indices;
    GLsizei count = 0;
  };
  struct Target {
    int width = 0, height = 0;
    GlTexture colour, depth;
    GlFramebuffer framebuffer;
  };

  static BodyMesh upload(const Body& body);
  void makeTarget(int width, int height);
  void drawDepth(const Target& map, const Matrix& camera, const std::vector<Placed>& bodies);
  void drawScene(const Orbit& camera, const std::vector<Placed>& bodies);
  void drawCloth(const GlProgram& program);
  void drawBodies(const GlProgram& program, const std::vector<Placed>& bodies);
  void setLight(const GlProgram& program, const Matrix& camera, Vector eye) const;

  Scene scene_;
  double reach_ = 1.0;  ///< radius of all that throws shadows
  Vector middle_;
  GlTexture positions_, normals_;
  std::vector<BodyMesh> bodies_;
  GlVertexArray nothing_;
  GlProgram clothDepth_, bodyDepth_, cloth_, body_, ground_, background_, resolve_;
  Target sun_, sky_, picture_;
  Matrix toSun_{}, toSky_{};
};

}  // namespace examples
