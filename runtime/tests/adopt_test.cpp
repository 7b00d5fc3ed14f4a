// SPDX-License-Identifier: MIT
//
// Devices on the application's own context: results are right whatever state the application set, and that state is
// restored.
#include <cstdlib>
#include <iterator>
#include <map>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <catch2/catch.hpp>

#include "elements.hpp"
#include "error_of.hpp"
#include "gl/open_context.hpp"
#include "sk/sk.hpp"
#include "test_kernel.hpp"

using namespace sk;
using namespace sk::test;

namespace {

/// An application's context. The constructor makes it current.
class Application {
 public:
  /// Compute is a core context of version 4.3 or later; Core asks for 3.3.
  enum class Kind { Core, Compute, Compatibility, Es };

  explicit Application(Kind kind) : kind_(kind) {
    eglBindAPI(kind == Kind::Es ? EGL_OPENGL_ES_API : EGL_OPENGL_API);
    for (const gl::DisplayCandidate& candidate : gl::displayCandidates()) {
      if (context_ == EGL_NO_CONTEXT) {
        display_ = gl::openDisplay(candidate);
        open();
      }
    }
    REQUIRE(context_ != EGL_NO_CONTEXT);
    makeCurrent();
  }
  ~Application() {
    eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display_, context_);
  }
  Application(const Application&) = delete;
  Application& operator=(const Application&) = delete;

  void makeCurrent() {
    REQUIRE(eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_) == EGL_TRUE);
  }
  void leave() { eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT); }
  bool isEs() const { return kind_ == Kind::Es; }
  bool isCompatibility() const { return kind_ == Kind::Compatibility; }

 private:
  void open() {
    if (display_ == EGL_NO_DISPLAY || eglInitialize(display_, nullptr, nullptr) != EGL_TRUE) {
      return;
    }
    std::vector<EGLint> attributes{EGL_CONTEXT_MAJOR_VERSION, kind_ == Kind::Compute ? 4 : 3,
                                   EGL_CONTEXT_MINOR_VERSION, isEs() ? 0 : 3};
    if (!isEs()) {
      attributes.insert(attributes.end(), {EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                           isCompatibility() ? EGL_CONTEXT_OPENGL_COMPATIBILITY_PROFILE_BIT
                                                             : EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT});
    }
    attributes.push_back(EGL_NONE);
    const EGLint any[] = {EGL_SURFACE_TYPE, 0, EGL_RENDERABLE_TYPE,
                          isEs() ? EGL_OPENGL_ES3_BIT : EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display_, any, &config, 1, &count) == EGL_TRUE && count > 0) {
      context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, attributes.data());
    }
  }

  Kind kind_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

GLint integerOf(GLenum name) {
  GLint values[16] = {};
  glGetIntegerv(name, values);
  return values[0];
}

GLfloat floatOf(GLenum name) {
  GLfloat value = 0;
  glGetFloatv(name, &value);
  return value;
}

GLuint compile(GLenum stage, const char* text) {
  const GLuint shader = glCreateShader(stage);
  glShaderSource(shader, 1, &text, nullptr);
  glCompileShader(shader);
  return shader;
}

bool hasClipControl(const Application& application) {
  return !application.isEs() && epoxy_gl_version() >= 45;
}

/// Sets as much state as possible to values that would spoil a pass.
void makeHostileState(const Application& application) {
  const bool isEs = application.isEs();
  for (const GLenum toggle : {GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE,
                              GL_RASTERIZER_DISCARD, GL_SAMPLE_ALPHA_TO_COVERAGE, GL_SAMPLE_COVERAGE}) {
    glEnable(toggle);
  }
  glCullFace(GL_FRONT_AND_BACK);
  glDepthFunc(GL_NEVER);
  glStencilFunc(GL_NEVER, 0, 0);
  glBlendFunc(GL_ZERO, GL_ONE);
  glScissor(1, 2, 3, 4);
  glViewport(5, 6, 7, 8);
  glColorMask(GL_FALSE, GL_TRUE, GL_FALSE, GL_TRUE);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 8);
  glPixelStorei(GL_UNPACK_ROW_LENGTH, 5);
  glPixelStorei(GL_UNPACK_SKIP_ROWS, 2);
  glPixelStorei(GL_UNPACK_SKIP_PIXELS, 3);
  glPixelStorei(GL_PACK_ALIGNMENT, 2);
  glPixelStorei(GL_PACK_ROW_LENGTH, 7);
  glPixelStorei(GL_PACK_SKIP_ROWS, 1);
  GLuint names[2] = {};
  glGenBuffers(2, names);
  glBindBuffer(GL_PIXEL_PACK_BUFFER, names[0]);
  glBindBuffer(GL_PIXEL_UNPACK_BUFFER, names[1]);
  glGenTextures(2, names);
  GLuint samplers[2] = {};
  glGenSamplers(2, samplers);
  for (GLuint unit = 0; unit < 2; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, names[unit]);
    glBindSampler(unit, samplers[unit]);
    glSamplerParameteri(samplers[unit], GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  }
  glActiveTexture(GL_TEXTURE0 + 3);
  glGenVertexArrays(1, names);
  glBindVertexArray(names[0]);
  glGenFramebuffers(2, names);
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, names[0]);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, names[1]);
  if (!isEs) {
    glEnable(GL_COLOR_LOGIC_OP);
    glLogicOp(GL_CLEAR);
    glEnable(GL_CLIP_DISTANCE0);
    glPolygonMode(GL_FRONT_AND_BACK, GL_POINT);
    glPixelStorei(GL_UNPACK_SWAP_BYTES, 1);
    glPixelStorei(GL_PACK_SWAP_BYTES, 1);
    glClampColor(GL_CLAMP_READ_COLOR, GL_TRUE);
    glDisablei(GL_BLEND, 1);
  }
  if (hasClipControl(application)) {
    glClipControl(GL_UPPER_LEFT, GL_ZERO_TO_ONE);
  }
  if (application.isCompatibility()) {
    glEnable(GL_ALPHA_TEST);
    glAlphaFunc(GL_NEVER, 0.0f);
    glClampColor(GL_CLAMP_FRAGMENT_COLOR, GL_TRUE);
    glClampColor(GL_CLAMP_VERTEX_COLOR, GL_TRUE);
    glPixelTransferf(GL_RED_SCALE, 2);
    glPixelTransferf(GL_ALPHA_BIAS, 0.5f);
  }
  const char* header = isEs ? "#version 300 es\n" : "#version 330\n";
  const GLuint program = glCreateProgram();
  glAttachShader(program,
                 compile(GL_VERTEX_SHADER,
                         (std::string(header) + "void main() { gl_Position = vec4(0.0); }\n").c_str()));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, (std::string(header) + "void main() { }\n").c_str()));
  glLinkProgram(program);
  glUseProgram(program);
  REQUIRE(glGetError() == GL_NO_ERROR);
}

/// The state that makeHostileState() sets, and more, by name.
std::map<std::string, GLint> readState(const Application& application) {
  std::map<std::string, GLint> state;
#define STATE(name) state[#name] = integerOf(name)
  STATE(GL_DITHER), STATE(GL_BLEND), STATE(GL_DEPTH_TEST), STATE(GL_STENCIL_TEST), STATE(GL_SCISSOR_TEST),
      STATE(GL_CULL_FACE);
  STATE(GL_RASTERIZER_DISCARD), STATE(GL_SAMPLE_ALPHA_TO_COVERAGE), STATE(GL_SAMPLE_COVERAGE);
  STATE(GL_UNPACK_ALIGNMENT), STATE(GL_UNPACK_ROW_LENGTH), STATE(GL_UNPACK_SKIP_ROWS),
      STATE(GL_UNPACK_SKIP_PIXELS);
  STATE(GL_PACK_ALIGNMENT), STATE(GL_PACK_ROW_LENGTH), STATE(GL_PACK_SKIP_ROWS);
  STATE(GL_PIXEL_PACK_BUFFER_BINDING), STATE(GL_PIXEL_UNPACK_BUFFER_BINDING), STATE(GL_VERTEX_ARRAY_BINDING);
  STATE(GL_DRAW_FRAMEBUFFER_BINDING), STATE(GL_READ_FRAMEBUFFER_BINDING), STATE(GL_CURRENT_PROGRAM),
      STATE(GL_ACTIVE_TEXTURE);
  if (!application.isEs()) {
    STATE(GL_COLOR_LOGIC_OP), STATE(GL_CLIP_DISTANCE0), STATE(GL_POLYGON_MODE), STATE(GL_UNPACK_SWAP_BYTES);
    STATE(GL_PACK_SWAP_BYTES), STATE(GL_CLAMP_READ_COLOR);
    state["blend 1"] = glIsEnabledi(GL_BLEND, 1);
  }
  if (application.isCompatibility()) {
    STATE(GL_ALPHA_TEST), STATE(GL_CLAMP_FRAGMENT_COLOR), STATE(GL_CLAMP_VERTEX_COLOR), STATE(GL_RED_SCALE);
    state["alpha bias"] = static_cast<GLint>(100 * floatOf(GL_ALPHA_BIAS));
  }
  if (hasClipControl(application)) {
    STATE(GL_CLIP_ORIGIN), STATE(GL_CLIP_DEPTH_MODE);
  }
#undef STATE
  GLint values[4] = {};
  for (const auto& [name, text] :
       {std::pair<GLenum, const char*>{GL_VIEWPORT, "viewport"}, {GL_SCISSOR_BOX, "scissor"}}) {
    glGetIntegerv(name, values);
    for (int i = 0; i < 4; ++i) {
      state[text + std::to_string(i)] = values[i];
    }
  }
  GLboolean mask[4] = {};
  glGetBooleanv(GL_COLOR_WRITEMASK, mask);
  for (int i = 0; i < 4; ++i) {
    state["mask" + std::to_string(i)] = mask[i];
  }
  const GLint active = integerOf(GL_ACTIVE_TEXTURE);
  for (GLuint unit = 0; unit < 4; ++unit) {
    glActiveTexture(GL_TEXTURE0 + unit);
    state["texture" + std::to_string(unit)] = integerOf(GL_TEXTURE_BINDING_2D);
    state["sampler" + std::to_string(unit)] = integerOf(GL_SAMPLER_BINDING);
  }
  glActiveTexture(static_cast<GLenum>(active));
  return state;
}

const TestKernel& mix3() {
  static const TestKernel kernel(
      "mix3",
      "void mix3(float a, float b, Hit h, out float r, out Hit s) { r = a + 10.0 * b; s = Hit(h.t + a, h.id "
      "+ 1); }\n",
      {input<float>("a"), input<float>("b"), input<Hit>("h"), output<float>("r"), output<Hit>("s")},
      hitDeclaration);
  return kernel;
}

const TestKernel& put() {
  static const TestKernel kernel("put", "void put(float x) { sk_put_r(sk_index().xy, x); }\n",
                                 {input<float>("x"), scatter<float>("r", 2, 1)});
  return kernel;
}

/// Uses a device in every way and checks the results.
void useAll(Device& device) {
  constexpr std::size_t count = 150;
  auto a = device.stream<float>(count);
  auto b = device.stream<float>(count);
  auto h = device.stream<Hit>(count);
  auto r = device.stream<float>(count);
  a.write(std::vector<float>(count, 2.5f));
  b.write(std::vector<float>(count, -3.0f));
  h.write(std::vector<Hit>(count, Hit{1.0f, 7}));
  mix3()(a, b, h, r, h);
  mix3()(a.domain(5, 10), b.domain(5, 10), h.domain(5, 10), a.domain(5, 10), h.domain(5, 10));
  CHECK(r.read() == std::vector<float>(count, -27.5f));
  CHECK(h.read()[4] == Hit{3.5f, 8});
  CHECK(h.read()[5] == Hit{6.0f, 9});
  CHECK(a.read()[9] == -27.5f);
  CHECK(sumOfFloats().value<float>(r) == -27.5f * count);
  std::vector<float> rising(5 * 7);
  std::iota(rising.begin(), rising.end(), 0.0f);
  auto grid = device.stream<float>({5, 7});
  auto copy = device.stream<float>({5, 7});
  grid.write(rising);
  put()(grid, copy);
  CHECK(copy.read() == rising);
  CHECK(device.arithmetic().exactSums);
}

}  // namespace

namespace {

/// Contexts with compute programs, and profiles that use them.
const std::vector<std::pair<Application::Kind, std::string>> dispatching{
    {Application::Kind::Compute, "glsl330"},
    {Application::Kind::Compute, "glsl430"},
    {Application::Kind::Es, "essl310"}};

}  // namespace

TEST_CASE("a device on the application's context works in any state and puts it back") {
  const auto kind =
      GENERATE(Application::Kind::Core, Application::Kind::Compatibility, Application::Kind::Es);
  const auto limit = GENERATE(0, 16);
  Application application(kind);
  makeHostileState(application);
  const auto before = readState(application);
  REQUIRE(glGetError() == GL_NO_ERROR);
  {
    Device device = Device::adopt({.textureLimit = limit});
    CHECK(readState(application) == before);
    CHECK(device.profile() == (application.isEs() ? "essl300" : "glsl330"));
    useAll(device);
    CHECK(readState(application) == before);
    device.finish();
    CHECK(readState(application) == before);
  }
  CHECK(readState(application) == before);
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("the buffers of the application's programs are theirs again after a reduction") {
  const auto& [kind, profile] = GENERATE(from_range(dispatching));
  Application application(kind);
  GLuint buffers[2] = {};
  glGenBuffers(2, buffers);
  for (const GLuint buffer : buffers) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer);
    glBufferData(GL_SHADER_STORAGE_BUFFER, 1024, nullptr, GL_STATIC_DRAW);
  }
  const bool isPart = GENERATE(false, true);
  if (isPart) {
    glBindBufferRange(GL_SHADER_STORAGE_BUFFER, 0, buffers[0], 256, 512);
  } else {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, buffers[0]);
  }
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, buffers[1]);
  glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffers[1]);
  Device device = Device::adopt({.profile = profile});
  auto ones = device.stream<float>({100, 7});
  ones.write(std::vector<float>(700, 1.0f));
  CHECK(sumOfFloats().value<float>(ones) == 700);
  GLint first = 0;
  GLint64 start = 0, size = 0;
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 0, &first);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_START, 0, &start);
  glGetInteger64i_v(GL_SHADER_STORAGE_BUFFER_SIZE, 0, &size);
  CHECK(first == static_cast<GLint>(buffers[0]));
  static const TestKernel counting(
      "counting", "void counting(float x, out float r) { r = 0.0; while (r < x) r += 1.0; }\n",
      {input<float>("x"), output<float>("r")});
  auto counted = device.stream<float>({100, 7});
  counting(ones, counted);
  CHECK(counted.read() == std::vector<float>(700, 1.0f));
  glGetIntegeri_v(GL_SHADER_STORAGE_BUFFER_BINDING, 1, &first);
  CHECK(first == static_cast<GLint>(buffers[1]));
  CHECK(start == (isPart ? 256 : 0));
  CHECK(size == (isPart ? 512 : 0));
  CHECK(integerOf(GL_SHADER_STORAGE_BUFFER_BINDING) == static_cast<GLint>(buffers[1]));
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("a loop on the application's context ends by itself and puts the state back") {
  static const TestKernel grow("grow", "void grow(float x, out float r) { r = 2.0 * x; }\n",
                               {input<float>("x"), output<float>("r")});
  static const TestKernel isLarge("isLarge", "void isLarge(float x, out bool r) { r = x > 900.0; }\n",
                                  {input<float>("x"), output<bool>("r")});
  const auto& [kind, profile] = GENERATE(from_range(dispatching));
  Application application(kind);
  makeHostileState(application);
  constexpr std::pair<GLenum, GLenum> bindings[] = {
      {GL_DRAW_INDIRECT_BUFFER, GL_DRAW_INDIRECT_BUFFER_BINDING},
      {GL_DISPATCH_INDIRECT_BUFFER, GL_DISPATCH_INDIRECT_BUFFER_BINDING},
      {GL_COPY_READ_BUFFER, GL_COPY_READ_BUFFER_BINDING},
      {GL_COPY_WRITE_BUFFER, GL_COPY_WRITE_BUFFER_BINDING},
      {GL_SHADER_STORAGE_BUFFER, GL_SHADER_STORAGE_BUFFER_BINDING}};
  GLuint buffers[std::size(bindings)] = {};
  glGenBuffers(static_cast<GLsizei>(std::size(buffers)), buffers);
  for (std::size_t i = 0; i < std::size(bindings); ++i) glBindBuffer(bindings[i].first, buffers[i]);
  const auto before = readState(application);
  {
    Device device = Device::adopt({.profile = profile});
    auto x = device.stream<float>(1);
    auto done = device.stream<bool>(1);
    Loop loop = device.record([&] {
      grow(x, x);
      isLarge(x, done);
    });
    x.fill(1);
    CHECK(loop.until(done, {.every = 6}) == 10);
    CHECK(x.read() == std::vector<float>{1024});
    CHECK(readState(application) == before);
    loop.repeat(2);
    CHECK(x.read() == std::vector<float>{4096});
    CHECK(readState(application) == before);
    for (std::size_t i = 0; i < std::size(bindings); ++i) {
      CHECK(integerOf(bindings[i].second) == static_cast<GLint>(buffers[i]));
    }
  }
  CHECK(readState(application) == before);
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("transform feedback of the application is paused, not disturbed") {
  Application application(Application::Kind::Es);
  const char* varyings[] = {"v"};
  const GLuint program = glCreateProgram();
  glAttachShader(program, compile(GL_VERTEX_SHADER,
                                  "#version 300 es\nout float v;\nvoid main() { v = float(gl_VertexID); "
                                  "gl_Position = vec4(0.0); }\n"));
  glAttachShader(program, compile(GL_FRAGMENT_SHADER, "#version 300 es\nvoid main() { }\n"));
  glTransformFeedbackVaryings(program, 1, varyings, GL_INTERLEAVED_ATTRIBS);
  glLinkProgram(program);
  glUseProgram(program);
  GLuint buffer = 0;
  glGenBuffers(1, &buffer);
  glBindBufferBase(GL_TRANSFORM_FEEDBACK_BUFFER, 0, buffer);
  glBufferData(GL_TRANSFORM_FEEDBACK_BUFFER, 64, nullptr, GL_STREAM_READ);
  Device device = Device::adopt();
  glBeginTransformFeedback(GL_TRIANGLES);
  useAll(device);
  CHECK(integerOf(GL_TRANSFORM_FEEDBACK_ACTIVE) == 1);
  CHECK(integerOf(GL_TRANSFORM_FEEDBACK_PAUSED) == 0);
  CHECK(integerOf(GL_CURRENT_PROGRAM) == static_cast<GLint>(program));
  glEndTransformFeedback();
  CHECK(glGetError() == GL_NO_ERROR);
}

TEST_CASE("the texture of a stream is one of the application's context") {
  Application application(Application::Kind::Core);
  Device device = Device::adopt();
  auto stream = device.stream<float2>({3, 5});
  std::vector<float2> host(15);
  for (std::size_t i = 0; i < 15; ++i) {
    host[i] = {static_cast<float>(i), -static_cast<float>(i)};
  }
  stream.write(host);
  const StreamTexture texture = stream.texture();
  std::vector<float2> texels(15);
  glBindTexture(GL_TEXTURE_2D, texture.name);
  glGetTexImage(GL_TEXTURE_2D, 0, GL_RG, GL_FLOAT, texels.data());
  CHECK(texels == host);
  CHECK(texture.internalFormat == GL_RG32F);
}

TEST_CASE("how the application filters the texture of a stream is nothing to kernels") {
  Application application(Application::Kind::Core);
  Device device = Device::adopt();
  auto x = device.stream<float>({37, 53});
  auto r = device.stream<float>({37, 53});
  std::vector<float> host(x.shape().size());
  for (std::size_t i = 0; i < host.size(); ++i) host[i] = i % 3 == 0 ? 1e12f : static_cast<float>(i);
  x.write(host);
  glBindTexture(GL_TEXTURE_2D, x.texture().name);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  twice()(x, r);
  for (float& value : host) value *= 2;
  CHECK(r.read() == host);
}

TEST_CASE("an adopted context that is not current, or gone, or none") {
  CHECK(errorOf([] { Device::adopt(); }) ==
        "there is no context to adopt; make one current on this thread by EGL or GLX first");
  auto application = std::make_unique<Application>(Application::Kind::Core);
  CHECK(errorOf([] { Device::adopt({.profile = "essl300"}); }) ==
        "the context to adopt is one of OpenGL, which profile essl300 does not run on");
  Device device = Device::adopt();
  auto stream = device.stream<float>(3);
  stream.write(std::vector<float>{1, 2, 3});
  application->leave();
  CHECK(errorOf([&] { (void)stream.read(); }) ==
        "the context that the device adopted is not current on this thread; make it current before you use "
        "the device or its "
        "streams");
  {
    auto destroyedMeanwhile = std::move(stream);
  }
  application->makeCurrent();
  useAll(device);
  SECTION("the application ends its context first") {
    application.reset();
    CHECK(errorOf([&] { device.stream<float>(1); }).find("not current") != std::string::npos);
  }
  SECTION("the device ends first") { device = Device(); }
}

TEST_CASE("a device of our own puts the application's context back") {
  Application application(Application::Kind::Core);
  EGLContext mine = eglGetCurrentContext();
  {
    Device device;
    CHECK(eglGetCurrentContext() == mine);
    useAll(device);
    CHECK(eglGetCurrentContext() == mine);
  }
  CHECK(eglGetCurrentContext() == mine);
}

TEST_CASE("the environment chooses for an adopted context what its options leave open") {
  class Variable {
   public:
    Variable(const char* name, const char* value) : name_(name) { ::setenv(name, value, 1); }
    ~Variable() { ::unsetenv(name_); }

   private:
    const char* const name_;
  };
  const Application application(Application::Kind::Core);
  const int most = Device::adopt().limits().textureUnits;
  REQUIRE(most > 16);
  {
    const Variable limits("SK_LIMITS", "guaranteed"), barrier("SK_BARRIER", "xor");
    CHECK(Device::adopt().limits().textureUnits == 16);
    CHECK(Device::adopt().arithmetic().barrier == Barrier::Xor);
    CHECK(Device::adopt({.limits = "device"}).limits().textureUnits == most);
  }
  for (const char* name : {"SK_LIMITS", "SK_DOUBLES", "SK_BARRIER", "SK_PROFILE"}) {
    const Variable wrong(name, "no such choice");
    CAPTURE(name);
    CHECK(errorOf([] { static_cast<void>(Device::adopt()); }).find(name) != std::string::npos);
  }
  const Variable profile("SK_PROFILE", "essl300");
  CHECK(errorOf([] { static_cast<void>(Device::adopt()); }).find("which profile essl300 does not run on") !=
        std::string::npos);
}

TEST_CASE("errors of the application lose no stream of an adopted context") {
  for (const Application::Kind kind : {Application::Kind::Core, Application::Kind::Es}) {
    Application application(kind);
    GLuint buffer = 0;
    glGenBuffers(1, &buffer);
    glBindBuffer(GL_ARRAY_BUFFER, buffer);
    const auto exhaustMemory = [] {
      glBufferData(GL_ARRAY_BUFFER, GLsizeiptr{1} << 50, nullptr, GL_STATIC_DRAW);
    };
    exhaustMemory();
    REQUIRE(glGetError() == GL_OUT_OF_MEMORY);
    exhaustMemory();
    Device device = Device::adopt();
    auto x = device.stream<float>({3}), r = device.stream<float>({3});
    x.write(std::vector<float>{1, 2, 3});
    exhaustMemory();
    twice()(x, r);
    exhaustMemory();
    glEnable(GL_INVALID_ENUM);
    CHECK(r.read() == std::vector<float>{2, 4, 6});
    exhaustMemory();
    CHECK_NOTHROW(device.finish());
    CHECK(sumOfFloats().value<float>(r) == 12);
    CHECK(glGetError() == GL_NO_ERROR);
    glDeleteBuffers(1, &buffer);
  }
}
