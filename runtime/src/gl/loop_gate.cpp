// SPDX-License-Identifier: MIT
#include "gl/loop_gate.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gl/buffer.hpp"
#include "gl/commands.hpp"

namespace sk::gl {

namespace {

/// The head of the buffer: its state, then the counts of a draw.
struct GateHead {
  GLuint isRunning = 1, ran = 0;
  GLuint corners = cornersOfViewport, instances = 1, first = 0, base = 0;
};
constexpr GLsizeiptr gateStateBytes = 2 * sizeof(GLuint);

constexpr std::string_view glHead = "#version 430\n", esHead = "#version 310 es\nprecision highp int;\n";
constexpr std::string_view gateText = R"(layout(local_size_x = 1) in;
layout(std430, binding = 0) buffer Gate {
  uint is_running, ran;
  uint corners, instances, first, base;
  uint groups[];
} gate;
uniform highp usampler2D condition;
uniform ivec4 place;
uniform int dispatches;
void main() {
  if (gate.is_running == 0u) return;
  gate.ran += 1u;
  if (texelFetch(condition, place.xy, 0)[place.z] == 0u) return;
  gate.is_running = 0u;
  gate.corners = 0u;
  for (int i = 0; i < dispatches; ++i) gate.groups[3 * i] = 0u;
}
)";

GLint boundBuffer(GLenum name) {
  GLint value = 0;
  glGetIntegerv(name, &value);
  return value;
}

}  // namespace

bool LoopGate::build(BoundState& bound, std::string& log) {
  if (program_) return true;
  std::string text(bound.isEs() ? esHead : glHead);
  text += gateText;
  Program program = Program::build(bound, {{}, std::move(text)}, log);
  if (!program) return false;
  bound.program(program.name());
  program.setSampler("condition", 0);
  place_ = {program.location("place"), true};
  dispatches_ = {program.location("dispatches"), false};
  program_ = std::move(program);
  return true;
}

bool LoopGate::open(BoundState& bound, std::span<const CommandLog::Groups> dispatches, bool isGuest,
                    std::string& log) {
  if (!build(bound, log)) return false;
  const GateHead head;
  const auto* const words = reinterpret_cast<const GLuint*>(&head);
  std::vector<GLuint> contents(words, words + sizeof head / sizeof(GLuint));
  for (const auto& [x, y] : dispatches) {
    contents.insert(contents.end(), {static_cast<GLuint>(x), static_cast<GLuint>(y), 1});
  }
  const auto create = [&](Buffer& buffer) {  // may throw, and so comes before all bindings
    if (!buffer) buffer = Buffer(bound.deletions, [] { return generated(glGenBuffers); });
  };
  create(buffer_);
  for (Answer& answer : answers_) create(answer.buffer);
  bound.errors.setAside();
  bound.storage(buffer_.get());
  glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(contents.size() * sizeof(GLuint)),
               contents.data(), GL_DYNAMIC_COPY);
  isGuest_ = isGuest;
  if (isGuest_) {
    drawBuffer_ = boundBuffer(GL_DRAW_INDIRECT_BUFFER_BINDING);
    dispatchBuffer_ = boundBuffer(GL_DISPATCH_INDIRECT_BUFFER_BINDING);
    readBuffer_ = boundBuffer(GL_COPY_READ_BUFFER_BINDING);
    writeBuffer_ = boundBuffer(GL_COPY_WRITE_BUFFER_BINDING);
  }
  for (Answer& answer : answers_) {
    glBindBuffer(GL_COPY_WRITE_BUFFER, answer.buffer.get());
    glBufferData(GL_COPY_WRITE_BUFFER, gateStateBytes, nullptr, GL_STREAM_READ);
  }
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, buffer_.get());
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer_.get());
  glBindBuffer(GL_COPY_READ_BUFFER, buffer_.get());
  asked_ = 0;
  count_ = static_cast<GLint>(dispatches.size());
  if (bound.errors.takeNew() == GL_NO_ERROR) return true;
  log = "it has no memory for a loop's counts";
  close(bound);
  return false;
}

IndirectCounts LoopGate::counts() const { return {.draw = gateStateBytes, .dispatches = sizeof(GateHead)}; }

// What draws and dispatches have written is visible to texture fetches; later ones must not overwrite the condition
// before it is read.
void LoopGate::pass(BoundState& bound, const Condition& condition, GLuint sampler) {
  bound.program(program_.name());
  bound.texture(0, condition.texture, false);
  bound.sampler(0, sampler);
  bound.storage(buffer_.get());
  place_.set(bound, {condition.place[0], condition.place[1], condition.place[2], 0});
  dispatches_.set(bound, count_);
  glDispatchCompute(1, 1, 1);
  glMemoryBarrier(GL_COMMAND_BARRIER_BIT | GL_SHADER_STORAGE_BARRIER_BIT |
                  GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
}

void LoopGate::ask(BoundState& bound) {
  Answer& answer = answers_[asked_++ % answers_.size()];
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  glBindBuffer(GL_COPY_WRITE_BUFFER, answer.buffer.get());
  glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, 0, 0, gateStateBytes);
  answer.fence = Fence::insert(bound.deletions);
}

LoopGate::State LoopGate::answer(BoundState& bound, std::size_t age) const {
  const Answer& answer = answers_[(asked_ - 1 - age) % answers_.size()];
  if (answer.fence) answer.fence.wait();
  std::array<GLuint, 2> state{};
  glBindBuffer(GL_COPY_WRITE_BUFFER, answer.buffer.get());
  readBuffer(bound, GL_COPY_WRITE_BUFFER, std::as_writable_bytes(std::span(state)));
  return {state[0] == 0, state[1]};
}

void LoopGate::close(BoundState&) {
  glBindBuffer(GL_DRAW_INDIRECT_BUFFER, static_cast<GLuint>(isGuest_ ? drawBuffer_ : 0));
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, static_cast<GLuint>(isGuest_ ? dispatchBuffer_ : 0));
  glBindBuffer(GL_COPY_READ_BUFFER, static_cast<GLuint>(isGuest_ ? readBuffer_ : 0));
  glBindBuffer(GL_COPY_WRITE_BUFFER, static_cast<GLuint>(isGuest_ ? writeBuffer_ : 0));
}

}  // namespace sk::gl
