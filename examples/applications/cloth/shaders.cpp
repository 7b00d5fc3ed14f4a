// SPDX-License-Identifier: MIT
#include "shaders.hpp"

namespace examples::shaders {
namespace {

// Two triangles a cell, without an index: the number of the vertex says which point it is. One whose links are torn is drawn as
// nothing.
constexpr const char* clothPoint = R"(
uniform samplerBuffer positions, normals;
uniform ivec2 size;
const ivec2 corners[6] = ivec2[6](ivec2(0, 0), ivec2(0, 1), ivec2(1, 0), ivec2(1, 0), ivec2(0, 1), ivec2(1, 1));
ivec2 pointOf(int vertex) {
  int cell = vertex / 6;
  return ivec2(cell % (size.x - 1), cell / (size.x - 1)) + corners[vertex % 6];
}
bool isWhole(int vertex) {
  int cell = vertex / 6;
  int faces = int(texelFetch(normals, cell / (size.x - 1) * size.x + cell % (size.x - 1)).w);
  return (faces & (vertex % 6 < 3 ? 1 : 2)) != 0;
}
)";

// What light does. `sun` and `sky` are pictures of depth from the light and from above: the first gives shadows, the second,
// blurred, how much of the sky is seen.
constexpr const char* light = R"(
uniform sampler2DShadow sun, sky;
uniform mat4 toSun, toSky;
uniform vec3 sunDirection, eye, background;
uniform float shadowRadius;
out vec4 colour;
const vec2 disc[12] = vec2[12](vec2(-.326, -.406), vec2(-.840, -.074), vec2(-.696, .457), vec2(-.203, .621),
  vec2(.962, -.195), vec2(.473, -.480), vec2(.519, .767), vec2(.185, -.893), vec2(.507, .064), vec2(.896, .412),
  vec2(-.322, -.933), vec2(-.092, .060));
float seen(sampler2DShadow map, mat4 to, vec3 at, float radius, float bias) {
  float angle = 6.2831853 * fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715))));
  mat2 turn = mat2(cos(angle), sin(angle), -sin(angle), cos(angle));
  vec4 p = to * vec4(at, 1);
  vec3 place = p.xyz * 0.5 + 0.5;
  float sum = 0.0;
  for (int i = 0; i < 12; ++i) sum += texture(map, vec3(place.xy + radius * (turn * disc[i]), place.z - bias));
  return sum / 12.0;
}
vec3 backgroundAt(float height) { return background * mix(0.72, 1.06, smoothstep(-0.2, 1.1, height)); }
uniform float pictureHeight;
float screenHeight() { return gl_FragCoord.y / pictureHeight; }
// A matt surface of this colour under sun and sky, both shadowed.
vec3 lit(vec3 albedo, vec3 at, vec3 n, out float sunlit) {
  float facing = dot(n, sunDirection);
  vec3 off = at + n * 0.012;
  sunlit = facing > 0.0 ? seen(sun, toSun, off, shadowRadius, 0.0012) : 0.0;
  float open = seen(sky, toSky, off, 0.055, 0.002);
  open = mix(0.35, 1.0, open);
  vec3 fromSky = mix(vec3(0.30, 0.27, 0.25), vec3(0.56, 0.60, 0.66), n.y * 0.5 + 0.5) * open;
  return albedo * (fromSky + vec3(1.38, 1.30, 1.16) * max(facing, 0.0) * sunlit);
}
float gleam(vec3 at, vec3 n, float sharpness) {
  vec3 halfway = normalize(sunDirection + normalize(eye - at));
  return pow(max(dot(n, halfway), 0.0), sharpness);
}
)";

constexpr const char* varyings = "in vec3 at; in vec3 normal; in vec2 place;\n";

// Patterns are averaged over a pixel's footprint by their integrals, so that they never flicker.
constexpr const char* cloth = R"(
uniform vec3 front, back, second;
uniform int pattern;
uniform vec2 repeats;
float stripes(float x, float share) {
  float w = max(fwidth(x), 1e-5);
  vec2 ends = vec2(x - 0.5 * w, x + 0.5 * w);
  vec2 sums = floor(ends) * share + max(fract(ends) - (1.0 - share), 0.0);
  return (sums.y - sums.x) / w;
}
float either(float a, float b) { return a + b - 2.0 * a * b; }
float patternAt(vec2 q) {
  if (pattern == 1) return stripes(q.y, 0.5);
  if (pattern == 2) return either(stripes(q.x, 0.5), stripes(q.y, 0.5));
  if (pattern == 3) return max(stripes(q.x, 0.12), stripes(q.y, 0.12));
  if (pattern == 4) return either(stripes(q.x + q.y, 0.5), stripes(q.x - q.y, 0.5));
  return 0.0;
}
// Threads, where they are large enough to be seen.
float weave(vec2 q) {
  vec2 w = fwidth(q);
  float visible = 1.0 - smoothstep(0.15, 0.5, max(w.x, w.y));
  return 1.0 + 0.10 * visible * sin(6.2831853 * q.x) * sin(6.2831853 * q.y);
}
void main() {
  vec3 view = normalize(eye - at);
  vec3 n = normalize(normal);
  if (!gl_FrontFacing) n = -n;
  vec2 q = place * repeats;
  vec3 albedo = gl_FrontFacing ? mix(front, second, patternAt(q)) : mix(back, back * 0.82, patternAt(q));
  albedo *= weave(q * 28.0);
  float sunlit;
  vec3 c = lit(albedo, at, n, sunlit);
  float through = max(-dot(n, sunDirection), 0.0);
  c += albedo * vec3(1.0, 0.85, 0.65) * 0.22 * through;
  float rim = pow(1.0 - max(dot(n, view), 0.0), 4.0);
  c += (albedo * 0.5 + 0.12) * rim * (0.25 + 0.5 * sunlit);
  c += 0.10 * gleam(at, n, 24.0) * sunlit;
  colour = vec4(c, 1);
}
)";

constexpr const char* body = R"(
uniform vec3 albedo;
void main() {
  vec3 n = normalize(normal);
  float sunlit;
  vec3 c = lit(albedo, at, n, sunlit);
  float rim = pow(1.0 - max(dot(n, normalize(eye - at)), 0.0), 5.0);
  c += vec3(0.05 + 0.25 * rim) * max(0.3 + 0.7 * n.y, 0.0) + 0.55 * gleam(at, n, 90.0) * sunlit;
  colour = vec4(c, 1);
}
)";

constexpr const char* ground = R"(
uniform vec3 albedo, middle;
uniform float reach;
void main() {
  float sunlit;
  vec3 c = lit(albedo, at, vec3(0, 1, 0), sunlit);
  float away = length(at.xz - middle.xz) / reach;
  colour = vec4(mix(c, backgroundAt(screenHeight()), smoothstep(0.35, 1.0, away)), 1);
}
)";

}  // namespace

std::string clothDepthVertex() {
  return std::string(clothPoint) + R"(
uniform mat4 camera;
void main() {
  ivec2 p = pointOf(gl_VertexID);
  gl_Position = isWhole(gl_VertexID) ? camera * vec4(texelFetch(positions, p.y * size.x + p.x).xyz, 1) : vec4(2, 2, 2, 1);
})";
}

std::string bodyDepthVertex() {
  return R"(
layout(location = 0) in vec3 vertex;
uniform mat4 camera;
uniform vec3 shift;
void main() { gl_Position = camera * vec4(vertex + shift, 1); })";
}

std::string depthFragment() { return "void main() {}"; }

std::string clothVertex() {
  return std::string(clothPoint) + R"(
uniform mat4 camera;
out vec3 at, normal;
out vec2 place;
void main() {
  ivec2 p = pointOf(gl_VertexID);
  int i = p.y * size.x + p.x;
  at = texelFetch(positions, i).xyz;
  normal = texelFetch(normals, i).xyz;
  place = vec2(p) / vec2(size - 1);
  gl_Position = isWhole(gl_VertexID) ? camera * vec4(at, 1) : vec4(2, 2, 2, 1);
})";
}

std::string bodyVertex() {
  return R"(
layout(location = 0) in vec3 vertex;
layout(location = 1) in vec3 vertexNormal;
uniform mat4 camera;
uniform vec3 shift;
out vec3 at, normal;
out vec2 place;
void main() {
  at = vertex + shift;
  normal = vertexNormal;
  place = vec2(0);
  gl_Position = camera * vec4(at, 1);
})";
}

std::string groundVertex() {
  return R"(
uniform mat4 camera;
uniform vec3 middle;
uniform float reach;
out vec3 at, normal;
out vec2 place;
void main() {
  vec2 corner = vec2(gl_VertexID % 2, gl_VertexID / 2) * 2.0 - 1.0;
  at = middle + 1.5 * reach * vec3(corner.x, 0, corner.y);
  normal = vec3(0, 1, 0);
  place = corner;
  gl_Position = camera * vec4(at, 1);
})";
}

std::string clothFragment() { return std::string(varyings) + light + cloth; }
std::string bodyFragment() { return std::string(varyings) + light + body; }
std::string groundFragment() { return std::string(varyings) + light + ground; }

std::string screenVertex() {
  return R"(
void main() { gl_Position = vec4(vec2(gl_VertexID % 2, gl_VertexID / 2) * 4.0 - 1.0, 1, 1); })";
}

std::string backgroundFragment() {
  return std::string(light) + "void main() { colour = vec4(backgroundAt(screenHeight()), 1); }";
}

std::string resolveFragment() {
  return R"(
uniform sampler2D picture;
uniform int factor;
out vec4 colour;
// Highlights are bent towards white instead of being cut off.
vec3 shown(vec3 c) { return c * (1.0 + c * 0.16) / (1.0 + 0.42 * c); }
vec3 encoded(vec3 c) { return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, c)); }
void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * factor;
  vec3 sum = vec3(0);
  for (int y = 0; y < factor; ++y)
    for (int x = 0; x < factor; ++x) sum += shown(max(texelFetch(picture, first + ivec2(x, y), 0).rgb, 0.0));
  float grain = fract(52.9829189 * fract(dot(gl_FragCoord.xy, vec2(0.06711056, 0.00583715)))) - 0.5;
  colour = vec4(encoded(min(sum / float(factor * factor), 1.0)) + grain / 255.0, 1);
})";
}

}  // namespace examples::shaders
