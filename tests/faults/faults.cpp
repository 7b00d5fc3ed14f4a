// SPDX-License-Identifier: MIT
//
// The functions that replace the driver's in libepoxy's function pointers.
#include "faults.hpp"

#include <array>
#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>
#include <set>
#include <string_view>
#include <tuple>
#include <type_traits>
#include <utility>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/stat.h>
#include <unistd.h>

namespace faults {

namespace {

// ---- what fails ------------------------------------------------------------------------------------

struct Armed {
  std::atomic<bool> is = false, hasFired = false;
  bool isLasting = false;
  Kind kind{};
  long number = 0, passed = 0;
  std::atomic<long> seen = 0;
};
Armed armed;
thread_local bool mayFail = false;  ///< true on the test's thread while a fault is armed
thread_local int inDriver = 0;  ///< above 0 inside the driver, whose own allocations do not fail

/// Counts an opportunity. Returns whether it fails.
bool fails(Kind kind) {
  if (!armed.is || armed.kind != kind) return false;
  const long seen = ++armed.seen;
  const bool isNow = armed.isLasting ? seen >= armed.number : seen == armed.number;
  if (isNow) armed.hasFired = true;
  return isNow;
}

// ---- living objects ---------------------------------------------------------------------------------

enum Object : std::uint8_t {
  Texture,
  Framebuffer,
  Buffer,
  Sampler,
  VertexArray,
  Query,
  Shader,
  Program,
  Sync
};
constexpr std::array<std::string_view, 9> objectNames = {
    "texture", "framebuffer", "buffer", "sampler", "vertex array", "query", "shader", "program", "fence"};

struct Tracked {
  std::set<std::tuple<void*, Object, std::uintptr_t>> living;
  std::set<void*> contexts, lost;
  long wrong = 0, left = 0;
  GLenum error = GL_NO_ERROR;  ///< left by a fault, for glGetError
};
std::atomic<long> countedBlocks = 0;
std::atomic<long> countedThreads = 0;
Tracked& tracked() {
  static Tracked all;
  return all;
}

// ---- calling the driver ----------------------------------------------------------------------------

template <auto* place, class F = std::remove_pointer_t<decltype(place)>>
struct Hook;
template <auto* place, class R, class... A>
struct Hook<place, R (*)(A...)> {
  static inline R (*driver)(A...) = nullptr;

  static void install(R (*standIn)(A...)) {
    driver = *place;
    *place = standIn;
  }
  /// Calls the driver's function. libepoxy resolves a function at its first call and then overwrites its own pointer.
  static R real(A... arguments) {
    const InDriver scope;
    R (*const standIn)(A...) = *place;
    *place = driver;
    const auto restore = [&] {
      driver = *place;
      *place = standIn;
    };
    if constexpr (std::is_void_v<R>) {
      driver(arguments...);
      restore();
    } else {
      const R result = driver(arguments...);
      restore();
      return result;
    }
  }
};

void* currentContext() {
  const InDriver scope;
  return Hook<&epoxy_eglGetCurrentContext>::driver != nullptr ? Hook<&epoxy_eglGetCurrentContext>::real()
                                                              : eglGetCurrentContext();
}

/// Whether the current context is lost, be it by this call. If so, leaves an error.
bool isLost() {
  if (!armed.is && tracked().lost.empty()) return false;
  const InDriver scope;
  if (fails(Kind::Context)) tracked().lost.insert(currentContext());
  if (!tracked().lost.contains(currentContext())) return false;
  tracked().error = GL_CONTEXT_LOST;
  return true;
}

/// Replaces a GL function that fails only in a lost context.
template <auto* place, class F = std::remove_pointer_t<decltype(place)>>
struct Plain;
template <auto* place, class R, class... A>
struct Plain<place, R (*)(A...)> {
  static R call(A... arguments) {
    if (isLost()) return R();
    return Hook<place>::real(arguments...);
  }
};

/// Replaces a GL function that can run out of memory, and then does nothing.
template <auto* place, Kind kind, class F = std::remove_pointer_t<decltype(place)>>
struct Failing;
template <auto* place, Kind kind, class R, class... A>
struct Failing<place, kind, R (*)(A...)> {
  static R call(A... arguments) {
    if (isLost()) return R();
    if (fails(kind)) {
      tracked().error = GL_OUT_OF_MEMORY;
      return R();
    }
    return Hook<place>::real(arguments...);
  }
};

void created(Object object, std::uintptr_t name) {
  const InDriver scope;
  if (name != 0) tracked().living.emplace(currentContext(), object, name);
}
void deleted(Object object, std::uintptr_t name) {
  const InDriver scope;
  if (name != 0 && tracked().living.erase({currentContext(), object, name}) == 0) ++tracked().wrong;
}

template <auto* place, Object object>
void generate(GLsizei count, GLuint* names) {
  if (isLost()) return;
  Hook<place>::real(count, names);
  for (GLsizei i = 0; i < count; ++i) created(object, names[i]);
}
template <auto* place, Object object>
void erase(GLsizei count, const GLuint* names) {
  for (GLsizei i = 0; i < count; ++i) deleted(object, names[i]);
  if (!isLost()) Hook<place>::real(count, names);
}
template <auto* place, Object object>
void eraseOne(GLuint name) {
  deleted(object, name);
  if (!isLost()) Hook<place>::real(name);
}

// ---- functions with special behaviour --------------------------------------------------------------

GLenum getError() {
  if (tracked().error != GL_NO_ERROR) return std::exchange(tracked().error, GL_NO_ERROR);
  const InDriver scope;
  return tracked().lost.contains(currentContext()) ? GL_NO_ERROR : Hook<&epoxy_glGetError>::real();
}

GLenum getResetStatus() {
  const InDriver scope;
  if (tracked().lost.contains(currentContext())) return GL_UNKNOWN_CONTEXT_RESET;
  return Hook<&epoxy_glGetGraphicsResetStatus>::real();
}

GLuint createShader(GLenum stage) {
  const GLuint name = Failing<&epoxy_glCreateShader, Kind::Program>::call(stage);
  created(Shader, name);
  return name;
}
GLuint createProgram() {
  const GLuint name = Failing<&epoxy_glCreateProgram, Kind::Program>::call();
  created(Program, name);
  return name;
}
/// A shader or program that the driver was never asked to compile or link has the status of a failure.
void compileShader(GLuint name) {
  if (isLost() || fails(Kind::Program)) return;
  Hook<&epoxy_glCompileShader>::real(name);
}
void linkProgram(GLuint name) {
  if (isLost() || fails(Kind::Program)) return;
  Hook<&epoxy_glLinkProgram>::real(name);
  if (armed.kind != Kind::Program) return;
  GLint isLinked = GL_FALSE;
  Hook<&epoxy_glGetProgramiv>::real(name, GL_LINK_STATUS, &isLinked);
  if (isLinked == GL_TRUE) armed.passed = armed.seen;
}
void loadBinary(GLuint name, GLenum format, const void* binary, GLsizei bytes) {
  if (isLost() || fails(Kind::Program)) return;
  Hook<&epoxy_glProgramBinary>::real(name, format, binary, bytes);
}

GLboolean unmapBuffer(GLenum target) {
  if (isLost()) return GL_FALSE;
  const bool isBad = fails(Kind::Mapping);
  return Hook<&epoxy_glUnmapBuffer>::real(target) == GL_TRUE && !isBad ? GL_TRUE : GL_FALSE;
}

GLsync fenceSync(GLenum condition, GLbitfield flags) {
  GLsync const sync = Failing<&epoxy_glFenceSync, Kind::Fence>::call(condition, flags);
  created(Sync, reinterpret_cast<std::uintptr_t>(sync));
  return sync;
}
void deleteSync(GLsync sync) {
  deleted(Sync, reinterpret_cast<std::uintptr_t>(sync));
  if (!isLost()) Hook<&epoxy_glDeleteSync>::real(sync);
}
GLenum clientWaitSync(GLsync sync, GLbitfield flags, GLuint64 time) {
  if (isLost() || fails(Kind::Fence)) return GL_WAIT_FAILED;
  return Hook<&epoxy_glClientWaitSync>::real(sync, flags, time);
}

GLenum checkFramebuffer(GLenum target) {
  if (isLost()) return 0;
  return fails(Kind::Framebuffer) ? GL_FRAMEBUFFER_UNSUPPORTED
                                  : Hook<&epoxy_glCheckFramebufferStatus>::real(target);
}

EGLContext createContext(EGLDisplay display, EGLConfig config, EGLContext shared, const EGLint* attributes) {
  EGLContext const made = Hook<&epoxy_eglCreateContext>::real(display, config, shared, attributes);
  const InDriver scope;
  if (made != EGL_NO_CONTEXT) tracked().contexts.insert(made);
  return made;
}
EGLBoolean destroyContext(EGLDisplay display, EGLContext context) {
  const InDriver scope;
  tracked().contexts.erase(context);
  tracked().lost.erase(context);
  tracked().left += static_cast<long>(
      std::erase_if(tracked().living, [&](const auto& object) { return std::get<0>(object) == context; }));
  return Hook<&epoxy_eglDestroyContext>::real(display, context);
}

/// Replaces an EGL function. It never fails, and allocations inside it count as the driver's.
template <auto* place, class F = std::remove_pointer_t<decltype(place)>>
struct PlainEgl;
template <auto* place, class R, class... A>
struct PlainEgl<place, R (*)(A...)> {
  static R call(A... arguments) { return Hook<place>::real(arguments...); }
};

// clang-format off: one function a line
#define PLAIN_FUNCTIONS                                                                                     \
  HOOK(glActiveTexture)                                                                                     \
  HOOK(glAttachShader)                                                                                      \
  HOOK(glBindBuffer)                                                                                        \
  HOOK(glBindBufferBase)                                                                                    \
  HOOK(glBindBufferRange)                                                                                   \
  HOOK(glBindFramebuffer)                                                                                   \
  HOOK(glBindImageTexture)                                                                                  \
  HOOK(glBindSampler)                                                                                       \
  HOOK(glBindTexture) HOOK(glBindVertexArray) HOOK(glBlendEquation) HOOK(glBlendEquationSeparate) HOOK(     \
      glBlendEquationSeparatei) HOOK(glBlendFunc) HOOK(glBlendFuncSeparate) HOOK(glBlendFuncSeparatei)      \
      HOOK(glClampColor) HOOK(glClipControl) HOOK(glClipControlEXT) HOOK(glColorMask) HOOK(                 \
          glColorMaski) HOOK(glDetachShader) HOOK(glDisable) HOOK(glDisablei) HOOK(glDrawBuffers)           \
          HOOK(glEnable) HOOK(glEnablei) HOOK(glFinish) HOOK(glFlush) HOOK(glFramebufferTexture2D) HOOK(    \
              glFramebufferTextureLayer) HOOK(glGetBooleani_v) HOOK(glGetBooleanv)                          \
              HOOK(glGetBufferParameteri64v) HOOK(glGetBufferSubData) HOOK(glGetFloati_v) HOOK(             \
                  glGetFloatv) HOOK(glGetInteger64i_v) HOOK(glGetInteger64v) HOOK(glGetIntegeri_v)          \
                  HOOK(glGetIntegerv) HOOK(glGetProgramBinary) HOOK(glGetProgramInfoLog) HOOK(              \
                      glGetProgramiv) HOOK(glGetQueryObjectui64v) HOOK(glGetQueryObjectuiv)                 \
                      HOOK(glGetQueryiv) HOOK(glGetShaderInfoLog) HOOK(glGetShaderiv) HOOK(                 \
                          glGetString) HOOK(glGetUniformLocation) HOOK(glIsEnabled) HOOK(glIsEnabledi)      \
                          HOOK(glMemoryBarrier) HOOK(glObjectLabel) HOOK(glPauseTransformFeedback) HOOK(    \
                              glPixelStorei) HOOK(glPixelTransferf) HOOK(glPointSize) HOOK(glPolygonMode)   \
                              HOOK(glPopDebugGroup) HOOK(glProgramParameteri) HOOK(glPushDebugGroup)        \
                                  HOOK(glQueryCounter) HOOK(glReadBuffer) HOOK(glReadPixels)                \
                                      HOOK(glResumeTransformFeedback) HOOK(glSamplerParameteri) HOOK(       \
                                          glShaderSource) HOOK(glTexParameteri) HOOK(glUniform1f)           \
                                          HOOK(glUniform1fv) HOOK(glUniform1i) HOOK(glUniform1iv) HOOK(     \
                                              glUniform1uiv) HOOK(glUniform2fv) HOOK(glUniform2iv)          \
                                              HOOK(glUniform2ui) HOOK(glUniform2uiv) HOOK(glUniform3fv)     \
                                                  HOOK(glUniform3iv) HOOK(glUniform3uiv) HOOK(glUniform4fv) \
                                                      HOOK(glUniform4iv) HOOK(glUniform4uiv)                \
                                                          HOOK(glUniformMatrix2fv) HOOK(glUniformMatrix3fv) \
                                                              HOOK(glUniformMatrix4fv) HOOK(glUseProgram)   \
                                                                  HOOK(glViewport) HOOK(glViewportIndexedf) \
                                                                      HOOK(glViewportIndexedfv)

#define PLAIN_EGL_FUNCTIONS                                                                            \
  HOOK(eglBindAPI)                                                                                     \
  HOOK(eglChooseConfig)                                                                                \
  HOOK(eglCreatePbufferSurface)                                                                        \
  HOOK(eglDestroySurface)                                                                              \
  HOOK(eglGetCurrentContext)                                                                           \
  HOOK(eglGetCurrentDisplay)                                                                           \
  HOOK(eglGetCurrentSurface)                                                                           \
  HOOK(eglGetDisplay)                                                                                  \
  HOOK(eglGetError) HOOK(eglGetProcAddress) HOOK(eglInitialize) HOOK(eglMakeCurrent) HOOK(eglQueryAPI) \
      HOOK(eglQueryString)
// clang-format on

}  // namespace

std::string nameOf(Kind kind) {
  constexpr std::array<std::string_view, 11> names = {"allocation",    "program", "mapping", "fence",
                                                      "framebuffer",   "command", "context", "host",
                                                      "host, threads", "file",    "thread"};
  return std::string(names[static_cast<std::size_t>(kind)]);
}

InDriver::InDriver() { ++inDriver; }
InDriver::~InDriver() { --inDriver; }

Fault::Fault(Kind kind, long number, bool isLasting) {
  armed.isLasting = isLasting;
  armed.kind = kind;
  armed.number = number;
  armed.seen = armed.passed = 0;
  armed.hasFired = false;
  mayFail = true;
  armed.is = true;
}
Fault::~Fault() {
  armed.is = mayFail = false;
  if (tracked().lost.empty()) tracked().error = GL_NO_ERROR;
}
bool Fault::hasFired() const { return armed.hasFired; }
long Fault::passed() const { return armed.passed; }

LiveObjects liveObjects() {
  LiveObjects found{static_cast<long>(tracked().living.size()), static_cast<long>(tracked().contexts.size()),
                    tracked().wrong, tracked().left};
  std::array<int, objectNames.size()> counts{};
  for (const auto& [context, object, name] : tracked().living) ++counts[object];
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) found.kinds += std::to_string(counts[i]) + " " + std::string(objectNames[i]) + " ";
  }
  return found;
}

long hostBlocks() { return countedBlocks; }
long startedThreads() { return countedThreads; }

void install() {
#define HOOK(function) Hook<&epoxy_##function>::install(Plain<&epoxy_##function>::call);
  PLAIN_FUNCTIONS
#undef HOOK
#define HOOK(function) Hook<&epoxy_##function>::install(PlainEgl<&epoxy_##function>::call);
  PLAIN_EGL_FUNCTIONS
#undef HOOK
#define HOOK(function, kind) Hook<&epoxy_##function>::install(Failing<&epoxy_##function, Kind::kind>::call);
  HOOK(glTexImage2D, Allocation)
  HOOK(glTexImage3D, Allocation)
  HOOK(glBufferData, Allocation)
  HOOK(glMapBufferRange, Mapping)
  HOOK(glDrawArrays, Command)
  HOOK(glDispatchCompute, Command)
  HOOK(glTexSubImage2D, Command)
  HOOK(glTexSubImage3D, Command)
  HOOK(glBlitFramebuffer, Command)
  HOOK(glCopyTexSubImage3D, Command)
#undef HOOK
#define HOOK(function, object) Hook<&epoxy_##function>::install(generate<&epoxy_##function, object>);
  HOOK(glGenTextures, Texture)
  HOOK(glGenFramebuffers, Framebuffer)
  HOOK(glGenBuffers, Buffer)
  HOOK(glGenSamplers, Sampler)
  HOOK(glGenVertexArrays, VertexArray)
  HOOK(glGenQueries, Query)
#undef HOOK
#define HOOK(function, object) Hook<&epoxy_##function>::install(erase<&epoxy_##function, object>);
  HOOK(glDeleteTextures, Texture)
  HOOK(glDeleteFramebuffers, Framebuffer)
  HOOK(glDeleteBuffers, Buffer)
  HOOK(glDeleteSamplers, Sampler)
  HOOK(glDeleteVertexArrays, VertexArray)
  HOOK(glDeleteQueries, Query)
#undef HOOK
  Hook<&epoxy_glCreateShader>::install(createShader);
  Hook<&epoxy_glCreateProgram>::install(createProgram);
  Hook<&epoxy_glDeleteShader>::install(eraseOne<&epoxy_glDeleteShader, Shader>);
  Hook<&epoxy_glDeleteProgram>::install(eraseOne<&epoxy_glDeleteProgram, Program>);
  Hook<&epoxy_glCompileShader>::install(compileShader);
  Hook<&epoxy_glLinkProgram>::install(linkProgram);
  Hook<&epoxy_glProgramBinary>::install(loadBinary);
  Hook<&epoxy_glUnmapBuffer>::install(unmapBuffer);
  Hook<&epoxy_glFenceSync>::install(fenceSync);
  Hook<&epoxy_glDeleteSync>::install(deleteSync);
  Hook<&epoxy_glClientWaitSync>::install(clientWaitSync);
  Hook<&epoxy_glCheckFramebufferStatus>::install(checkFramebuffer);
  Hook<&epoxy_glGetError>::install(getError);
  Hook<&epoxy_glGetGraphicsResetStatus>::install(getResetStatus);
  Hook<&epoxy_eglCreateContext>::install(createContext);
  Hook<&epoxy_eglDestroyContext>::install(destroyContext);
}

// ---- host memory -----------------------------------------------------------------------------------

namespace {

bool failsForHost() noexcept {
  if (!armed.is || inDriver > 0) return false;
  return armed.kind == Kind::HostOfAnyThread ? fails(armed.kind) : mayFail && fails(Kind::Host);
}

/// Precedes each block of operator new.
struct alignas(std::max_align_t) BlockHeader {
  bool isCounted = false;
};

void* allocateOrNull(std::size_t size) noexcept {
  if (size > std::numeric_limits<std::size_t>::max() - sizeof(BlockHeader)) return nullptr;
  void* const memory = std::malloc(sizeof(BlockHeader) + size);
  if (memory == nullptr) return nullptr;
  auto* const header = new (memory) BlockHeader{armed.is && mayFail && inDriver == 0};
  countedBlocks += header->isCounted ? 1 : 0;
  return header + 1;
}

/// Whether a call of the system by the runtime, on the test's thread, fails.
bool failsForSystem(Kind kind) noexcept { return armed.is && inDriver == 0 && mayFail && fails(kind); }

/// The function that a replacement stands for.
template <class Function>
Function systems(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

void countThread() noexcept {
  if (armed.is && inDriver == 0 && mayFail) ++countedThreads;
}

void* allocate(std::size_t size) {
  if (failsForHost()) throw std::bad_alloc();
  if (void* memory = allocateOrNull(size)) return memory;
  throw std::bad_alloc();
}

void deallocate(void* memory) noexcept {
  if (memory == nullptr) return;
  BlockHeader* const header = static_cast<BlockHeader*>(memory) - 1;
  countedBlocks -= header->isCounted ? 1 : 0;
  std::free(header);
}

}  // namespace

}  // namespace faults

void* operator new(std::size_t size) { return faults::allocate(size); }
void* operator new[](std::size_t size) { return faults::allocate(size); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept { return faults::allocateOrNull(size); }
void* operator new[](std::size_t size, const std::nothrow_t&) noexcept {
  return faults::allocateOrNull(size);
}
void operator delete(void* memory) noexcept { faults::deallocate(memory); }
void operator delete[](void* memory) noexcept { faults::deallocate(memory); }
void operator delete(void* memory, std::size_t) noexcept { faults::deallocate(memory); }
void operator delete[](void* memory, std::size_t) noexcept { faults::deallocate(memory); }
void operator delete(void* memory, const std::nothrow_t&) noexcept { faults::deallocate(memory); }
void operator delete[](void* memory, const std::nothrow_t&) noexcept { faults::deallocate(memory); }

// Native streams allocate their elements by it.
extern "C" int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  using Function = int (*)(void**, std::size_t, std::size_t);
  static const auto next = reinterpret_cast<Function>(dlsym(RTLD_NEXT, "posix_memalign"));
  return faults::failsForHost() ? ENOMEM : next(memory, alignment, size);
}

// ---- files and threads ------------------------------------------------------------------------------

extern "C" {

int openat(int folder, const char* name, int flags, ...) {
  static const auto next = faults::systems<int (*)(int, const char*, int, mode_t)>("openat");
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(rest, unsigned)) : mode_t{0};
  va_end(rest);
  if (!faults::failsForSystem(faults::Kind::File)) return next(folder, name, flags, mode);
  errno = EIO;
  return -1;
}
int open(const char* name, int flags, ...) {
  static const auto next = faults::systems<int (*)(const char*, int, mode_t)>("open");
  va_list rest;
  va_start(rest, flags);
  const auto mode = (flags & O_CREAT) != 0 ? static_cast<mode_t>(va_arg(rest, unsigned)) : mode_t{0};
  va_end(rest);
  if (!faults::failsForSystem(faults::Kind::File)) return next(name, flags, mode);
  errno = EIO;
  return -1;
}
int mkdir(const char* name, mode_t mode) noexcept {
  static const auto next = faults::systems<int (*)(const char*, mode_t)>("mkdir");
  if (!faults::failsForSystem(faults::Kind::File)) return next(name, mode);
  errno = EIO;
  return -1;
}
int renameat(int from, const char* name, int to, const char* newName) noexcept {
  static const auto next = faults::systems<int (*)(int, const char*, int, const char*)>("renameat");
  if (!faults::failsForSystem(faults::Kind::File)) return next(from, name, to, newName);
  errno = EIO;
  return -1;
}
ssize_t read(int file, void* bytes, std::size_t count) {
  static const auto next = faults::systems<ssize_t (*)(int, void*, std::size_t)>("read");
  if (!faults::failsForSystem(faults::Kind::File)) return next(file, bytes, count);
  errno = EIO;
  return -1;
}
/// Writes a half before it fails, as a disk that becomes full.
ssize_t write(int file, const void* bytes, std::size_t count) {
  static const auto next = faults::systems<ssize_t (*)(int, const void*, std::size_t)>("write");
  if (!faults::failsForSystem(faults::Kind::File)) return next(file, bytes, count);
  static_cast<void>(next(file, bytes, count / 2));
  errno = ENOSPC;
  return -1;
}

#if !defined(__SANITIZE_THREAD__)  // which replaces it, too
int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) noexcept {
  using Function = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto next = faults::systems<Function>("pthread_create");
  if (faults::failsForSystem(faults::Kind::Thread)) return EAGAIN;
  faults::countThread();
  return next(thread, attributes, start, argument);
}
#endif

}  // extern "C"
