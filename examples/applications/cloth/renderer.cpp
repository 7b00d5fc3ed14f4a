// SPDX-License-Identifier: MIT
#include "renderer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include <fmt/format.h>

#include "body_mesh.hpp"
#include "shaders.hpp"

namespace examples {
namespace {

constexpr int shadowSize = 2048;

GLint place(const GlProgram& program, const char* name) { return glGetUniformLocation(program.get(), name); }
void set(const GlProgram& p, const char* name, const Matrix& m) {
  glUniformMatrix4fv(place(p, name), 1, GL_FALSE, m.data());
}
void set(const GlProgram& p, const char* name, Vector v) {
  glUniform3f(place(p, name), static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z));
}
void set(const GlProgram& p, const char* name, double v) {
  glUniform1f(place(p, name), static_cast<float>(v));
}
void set(const GlProgram& p, const char* name, int v) { glUniform1i(place(p, name), v); }

/// From sRGB's curve to light.
Vector linear(Vector c) {
  const auto one = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return {one(c.x), one(c.y), one(c.z)};
}

void bind(int unit, GLenum target, GLuint texture) {
  glActiveTexture(static_cast<GLenum>(GL_TEXTURE0 + unit));
  glBindTexture(target, texture);
}

/// Where the ground is: the scene's own word, or its first plane that lies flat.
std::optional<double> floorOf(const Scene& scene) {
  if (scene.view.floor) return scene.view.floor;
  for (const Body& b : scene.bodies) {
    if (b.kind == Kind::Plane && b.along.y > 0.99) return dot(b.along, b.at);
  }
  return std::nullopt;
}

}  // namespace

Renderer::Renderer(const Scene& scene, const ClothBuffers& cloth) : scene_(scene) {
  if (!epoxy_is_desktop_gl() || epoxy_gl_version() < 33) {
    throw std::runtime_error(
        "drawing needs OpenGL 3.3; take another --device, or none of --output and --window");
  }
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  if (scene.points() > most) {
    throw std::runtime_error(
        fmt::format("this OpenGL draws cloths of up to {} points; take fewer --points", most));
  }
  positions_ = makeBufferTexture(GL_RGBA32F, cloth.positions);
  normals_ = makeBufferTexture(GL_RGBA32F, cloth.normals);
  for (const Body& body : scene.bodies) bodies_.push_back(upload(body));
  nothing_ = makeVertexArray();
  clothDepth_ = makeProgram(shaders::clothDepthVertex(), shaders::depthFragment());
  bodyDepth_ = makeProgram(shaders::bodyDepthVertex(), shaders::depthFragment());
  cloth_ = makeProgram(shaders::clothVertex(), shaders::clothFragment());
  body_ = makeProgram(shaders::bodyVertex(), shaders::bodyFragment());
  ground_ = makeProgram(shaders::groundVertex(), shaders::groundFragment());
  background_ = makeProgram(shaders::screenVertex(), shaders::backgroundFragment());
  resolve_ = makeProgram(shaders::screenVertex(), shaders::resolveFragment());
  for (Target* map : {&sun_, &sky_}) {
    map->width = map->height = shadowSize;
    map->depth = makeDepthTexture(shadowSize, shadowSize);
    map->framebuffer = makeFramebuffer(0, map->depth.get());
  }
  middle_ = scene.view.at;
  reach_ = 0.75 * length(scene.view.eye - scene.view.at) * std::tan(scene.view.fieldOfView * 0.00873) * 2.4;
  const Vector above{0, 0, -1};
  toSun_ = product(orthographic(reach_, 1.0), lookAt(middle_ + scene.view.light, middle_, {0, 1, 0}));
  toSky_ = product(orthographic(reach_, 1.0), lookAt(middle_ + Vector{0, 1, 0}, middle_, above));
}

Renderer::BodyMesh Renderer::upload(const Body& body) {
  const Mesh mesh = meshOf(body);
  BodyMesh result;
  result.array = makeVertexArray();
  result.count = static_cast<GLsizei>(mesh.triangles.size());
  if (result.count == 0) return result;
  std::vector<sk::float3> vertices = mesh.positions;
  vertices.insert(vertices.end(), mesh.normals.begin(), mesh.normals.end());
  glBindVertexArray(result.array.get());
  result.vertices = makeBuffer(static_cast<std::int64_t>(vertices.size() * sizeof(sk::float3)),
                               vertices.data(), GL_STATIC_DRAW);
  const std::size_t half = mesh.positions.size() * sizeof(sk::float3);
  for (const GLuint attribute : {0u, 1u}) {
    glEnableVertexAttribArray(attribute);
    glVertexAttribPointer(attribute, 3, GL_FLOAT, GL_FALSE, sizeof(sk::float3),
                          reinterpret_cast<const void*>(half * attribute));
  }
  result.indices = makeBuffer(static_cast<std::int64_t>(mesh.triangles.size() * sizeof(std::uint32_t)),
                              mesh.triangles.data(), GL_STATIC_DRAW);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, result.indices.get());
  glBindVertexArray(0);
  return result;
}

void Renderer::makeTarget(int width, int height) {
  if (picture_.width == width && picture_.height == height) return;
  picture_.width = width;
  picture_.height = height;
  picture_.colour = makeTexture(GL_RGBA16F, GL_RGBA, GL_FLOAT, width, height);
  picture_.depth = makeTexture(GL_DEPTH_COMPONENT24, GL_DEPTH_COMPONENT, GL_UNSIGNED_INT, width, height);
  picture_.framebuffer = makeFramebuffer(picture_.colour.get(), picture_.depth.get());
}

void Renderer::drawCloth(const GlProgram& program) {
  const int columns = scene_.cloth.columns, rows = scene_.cloth.rows;
  if (columns < 2 || rows < 2) return;
  bind(0, GL_TEXTURE_BUFFER, positions_.get());
  bind(1, GL_TEXTURE_BUFFER, normals_.get());
  set(program, "positions", 0);
  set(program, "normals", 1);
  glUniform2i(place(program, "size"), columns, rows);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLES, 0, 6 * (columns - 1) * (rows - 1));
}

void Renderer::drawBodies(const GlProgram& program, const std::vector<Placed>& bodies) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].count == 0) continue;
    set(program, "shift", vecOf<double>(bodies[i].at));
    set(program, "albedo", linear(scene_.bodies[i].colour));
    glBindVertexArray(bodies_[i].array.get());
    glDrawElements(GL_TRIANGLES, bodies_[i].count, GL_UNSIGNED_INT, nullptr);
  }
}

void Renderer::drawDepth(const Target& map, const Matrix& camera, const std::vector<Placed>& bodies) {
  glBindFramebuffer(GL_FRAMEBUFFER, map.framebuffer.get());
  glViewport(0, 0, map.width, map.height);
  glClear(GL_DEPTH_BUFFER_BIT);
  glUseProgram(clothDepth_.get());
  set(clothDepth_, "camera", camera);
  drawCloth(clothDepth_);
  glUseProgram(bodyDepth_.get());
  set(bodyDepth_, "camera", camera);
  drawBodies(bodyDepth_, bodies);
}

void Renderer::setLight(const GlProgram& program, const Matrix& camera, Vector eye) const {
  glUseProgram(program.get());
  set(program, "camera", camera);
  set(program, "sun", 2);
  set(program, "sky", 3);
  set(program, "toSun", toSun_);
  set(program, "toSky", toSky_);
  set(program, "sunDirection", scene_.view.light);
  set(program, "eye", eye);
  set(program, "background", linear(scene_.view.background));
  set(program, "shadowRadius", 0.006);
  set(program, "pictureHeight", static_cast<double>(picture_.height));
}

void Renderer::drawScene(const Orbit& orbit, const std::vector<Placed>& bodies) {
  const ViewSettings& v = scene_.view;
  const Vector eye = orbit.eye();
  const double distance = length(eye - orbit.at());
  const Matrix camera = product(
      perspective(v.fieldOfView, double(picture_.width) / picture_.height, 0.02 * distance, 20 * distance),
      lookAt(eye, orbit.at(), {0, 1, 0}));
  glBindFramebuffer(GL_FRAMEBUFFER, picture_.framebuffer.get());
  glViewport(0, 0, picture_.width, picture_.height);
  glClear(GL_DEPTH_BUFFER_BIT);
  bind(2, GL_TEXTURE_2D, sun_.depth.get());
  bind(3, GL_TEXTURE_2D, sky_.depth.get());

  glDepthMask(GL_FALSE);
  setLight(background_, camera, eye);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);

  if (const auto height = floorOf(scene_)) {
    setLight(ground_, camera, eye);
    set(ground_, "albedo", linear(v.ground));
    set(ground_, "middle", Vector{middle_.x, *height, middle_.z});
    set(ground_, "reach", 2.2 * reach_);
    glBindVertexArray(nothing_.get());
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  }
  setLight(body_, camera, eye);
  drawBodies(body_, bodies);

  setLight(cloth_, camera, eye);
  const double longer = std::max(scene_.cloth.width, scene_.cloth.height);
  set(cloth_, "front", linear(v.front));
  set(cloth_, "back", linear(v.back));
  set(cloth_, "second", linear(v.second));
  set(cloth_, "pattern", v.pattern);
  glUniform2f(place(cloth_, "repeats"), static_cast<float>(v.repeats * scene_.cloth.width / longer),
              static_cast<float>(v.repeats * scene_.cloth.height / longer));
  drawCloth(cloth_);
}

void Renderer::draw(const Orbit& camera, const std::vector<Placed>& bodies, int width, int height, int factor,
                    GLuint target) {
  makeTarget(width * factor, height * factor);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  drawDepth(sun_, toSun_, bodies);
  drawDepth(sky_, toSky_, bodies);
  drawScene(camera, bodies);

  glBindFramebuffer(GL_FRAMEBUFFER, target);
  glViewport(0, 0, width, height);
  glDisable(GL_DEPTH_TEST);
  glUseProgram(resolve_.get());
  bind(0, GL_TEXTURE_2D, picture_.colour.get());
  set(resolve_, "picture", 0);
  set(resolve_, "factor", factor);
  glBindVertexArray(nothing_.get());
  glDrawArrays(GL_TRIANGLES, 0, 3);
}

Image Renderer::picture(const Orbit& camera, const std::vector<Placed>& bodies, int width, int height,
                        int factor) {
  const GlTexture colour = makeTexture(GL_RGBA8, GL_RGBA, GL_UNSIGNED_BYTE, width, height);
  const GlFramebuffer target = makeFramebuffer(colour.get(), 0);
  draw(camera, bodies, width, height, factor, target.get());
  std::vector<std::uint8_t> rgba(std::size_t(width) * std::size_t(height) * 4);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  Image image{width, height, std::vector<std::uint8_t>(std::size_t(width) * std::size_t(height) * 3)};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::uint8_t* from =
          &rgba[(std::size_t(height - 1 - y) * std::size_t(width) + std::size_t(x)) * 4];
      std::copy(from, from + 3, image.pixel(x, y));
    }
  }
  return image;
}

}  // namespace examples
