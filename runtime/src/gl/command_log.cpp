// SPDX-License-Identifier: MIT
#include "gl/command_log.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>

#include "gl/bound_state.hpp"
#include "gl/commands.hpp"
#include "gl/program.hpp"

namespace sk::gl {

namespace {

using CommandKind = Command::Kind;

/// Whether a command acts each time, even if it is given twice.
bool alwaysActs(CommandKind kind) {
  return kind == CommandKind::Draw || kind == CommandKind::Dispatch || kind == CommandKind::FinishDraws;
}

}  // namespace

void CommandLog::note(FieldUniform& uniform, std::span<const std::byte> value) {
  note(CommandKind::Field, &uniform, value);
}

void CommandLog::note(WideUniform& uniform, double value) {
  note(CommandKind::Wide, &uniform, std::as_bytes(std::span(&value, 1)));
}

void CommandLog::note(CommandKind kind, void* uniform, std::span<const std::byte> value) {
  note({.kind = kind, .uniform = uniform, .bytes = bytes_.size(), .size = value.size()});
  bytes_.insert(bytes_.end(), value.begin(), value.end());
}

void CommandLog::forget(GLuint name, std::initializer_list<CommandKind> kinds) noexcept {
  isStale_ = isStale_ || std::ranges::any_of(commands_, [&](const Command& command) {
               return command.name == name && std::ranges::find(kinds, command.kind) != kinds.end();
             });
}

void CommandLog::giveAll(BoundState& bound, std::span<const Command> commands,
                         const IndirectCounts* counts) const {
  for (const Command& command : commands) give(bound, command, counts);
}

void CommandLog::give(BoundState& bound, const Command& command, const IndirectCounts* counts) const {
  const std::array<GLint, 4>& numbers = command.numbers;
  switch (command.kind) {
    case CommandKind::Program: return bound.program(command.name);
    case CommandKind::VertexArray: return bound.vertexArray(command.name);
    case CommandKind::Texture: return bound.texture(command.unit, command.name, false);
    case CommandKind::ArrayTexture: return bound.texture(command.unit, command.name, true);
    case CommandKind::Sampler: return bound.sampler(command.unit, command.name);
    case CommandKind::Image: return bound.image(command.unit, command.name, command.format);
    case CommandKind::Storage: return bound.keptStorage(command.name);
    case CommandKind::LoopStorage: return bound.loopStorage(command.name);
    case CommandKind::Framebuffer: return bound.framebuffer(command.name);
    case CommandKind::Viewport: return bound.viewport(numbers[0], numbers[1], numbers[2], numbers[3]);
    case CommandKind::Ints: return static_cast<IntUniform*>(command.uniform)->set(bound, numbers);
    case CommandKind::Field:
      return static_cast<FieldUniform*>(command.uniform)->setBytes(bytes_.data() + command.bytes);
    case CommandKind::Wide: {
      double value;
      std::memcpy(&value, bytes_.data() + command.bytes, sizeof value);
      return static_cast<WideUniform*>(command.uniform)->setValue(value);
    }
    case CommandKind::Draw:
      return counts == nullptr ? drawViewport(bound) : drawViewportIndirect(counts->draw);
    case CommandKind::Dispatch:
      return counts == nullptr
                 ? dispatch(bound, numbers[0], numbers[1])
                 : dispatchIndirect(counts->dispatches + command.unit * IndirectCounts::dispatchBytes);
    case CommandKind::FinishDraws: return finishDraws(bound);
  }
}

bool CommandLog::isSame(const Command& a, const Command& b, const CommandLog& ofB) const {
  const auto value = [](const CommandLog& log, const Command& command) {
    return std::span(log.bytes_).subspan(command.bytes, command.size);
  };
  return a.name == b.name && a.format == b.format && a.numbers == b.numbers &&
         std::ranges::equal(value(*this, a), value(ofB, b));
}

// What the first round leaves is what a later round finds.
void CommandLog::findChanges(std::span<CommandLog* const> cycle) {
  using Setting = std::tuple<CommandKind, GLint, void*>;
  std::map<Setting, std::pair<const CommandLog*, const Command*>> found;
  for (const bool isLater : {false, true}) {
    for (CommandLog* const log : cycle) {
      if (isLater) log->changes_.clear();
      for (const Command& command : log->commands_) {
        auto& [setBy, last] = found[{command.kind, command.unit, command.uniform}];
        const bool acts = alwaysActs(command.kind) || last == nullptr || !log->isSame(command, *last, *setBy);
        setBy = log;
        last = &command;
        if (isLater && acts) log->changes_.push_back(command);
      }
    }
  }
}

void CommandLog::setGroups(std::vector<Groups>& all) {
  for (std::vector<Command>* const list : {&commands_, &changes_}) {
    for (Command& command : *list) {
      if (command.kind != CommandKind::Dispatch) continue;
      const Groups groups{command.numbers[0], command.numbers[1]};
      auto known = std::ranges::find(all, groups);
      if (known == all.end()) known = all.insert(known, groups);
      command.unit = static_cast<GLint>(known - all.begin());
    }
  }
}

}  // namespace sk::gl
