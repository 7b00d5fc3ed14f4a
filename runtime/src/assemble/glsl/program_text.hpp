// SPDX-License-Identifier: MIT
//
// A program in the making: sections that grow while parameters are laid out, each
// declaration made by whoever mentions it first, then put in order around the kernel's own text.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "assemble/assemble.hpp"
#include "assemble/relayed_values.hpp"

namespace sk::assemble {

/// Invocations of a work group where each stores a texel of 16 bytes. Texels lie in squares in memory, and groups that cover some
/// of these whole are fastest, in columns; smaller groups take a large GPU longer to start than to run.
inline constexpr std::pair<int, int> groupOfWideTexels{8, 16};
/// Bytes that a work group may share, on any device.
inline constexpr std::size_t groupBytes = 32768;

/// Functions of the assembler's own that programs share; their text is in functions.cpp.
enum class Function : std::uint8_t {
  Unravel2,  ///< index of an element number in 2, 3 or 4 dimensions; the highest that is
  Unravel3,  ///< required serves for all
  Unravel4,
  Ravel,  ///< element number of an index
  Texel,  ///< texel of an element number
  Layered,  ///< texel of a layered texture
  Wrap,  ///< wrapped sum of an index and an offset
  WrapOnce,  ///< wrapped index that is less than an extent away
  Mirror,
  MirrorOnce,
  ToHalf,  ///< the nearest half of a float, as a float
  Local,  ///< where an invocation is in its group, groupOfWideTexels
  Sampled,  ///< texel of a 2-D texture, sampled at its centre
};
std::string_view text(Function function);

class ProgramText {
 public:
  ProgramText() = default;  ///< of what is drawn
  explicit ProgramText(const Profile& profile)
      : stage_(profile.stage), sharesTexels_(profile.sharesTexels), samples_(profile.samples) {}

  Stage stage() const { return stage_; }
  bool sharesTexels() const { return sharesTexels_ && stage_ == Stage::Compute; }
  /// Profile::samples
  bool samples() const { return samples_; }
  /// The texel that an invocation computes, an ivec2, and its coordinates: expressions.
  std::string_view texel() const { return isDrawn() ? "ivec2(gl_FragCoord.xy)" : "sk_pixel"; }
  std::string_view column() const { return isDrawn() ? "int(gl_FragCoord.x)" : "sk_pixel.x"; }
  std::string_view row() const { return isDrawn() ? "int(gl_FragCoord.y)" : "sk_pixel.y"; }
  /// From here on, uniforms come from the vertex program as far as there is room.
  void relayUniforms() { relaysUniforms_ = true; }
  const std::vector<RelayedValue>& relayed() const { return relayed_.all(); }
  /// Declares a uniform unless it is declared, and gives the name by which the program reads it.
  std::string uniform(std::string_view type, std::string_view name);
  /// Declares an input that is the same for the whole point or triangle.
  void flatInput(std::string_view type, std::string_view name);
  /// Declares the output of the next location: a variable of the type of a texel.
  void output(std::string_view type, std::string_view name);
  /// Where a compute program stores its outputs at the end of main(): an ivec2, or in array textures an ivec3.
  void storeAt(std::string_view place, bool isArray);
  /// It stores them in the buffer of binding 0 instead: each in 16 bytes, as four components.
  void storeInBuffer();
  /// Of a compute program: a work group of so many invocations computes a texel, and the first of them stores it.
  void dispatchGroups(std::int32_t width, std::int32_t height);
  /// Declares a global variable.
  void variable(std::string_view type, std::string_view name);
  /// Defines one of the shared functions unless it is defined.
  void require(Function function);
  /// Defines a function unless one of this signature is defined.
  void function(std::string_view signature, const std::vector<std::string>& statements);
  bool isDefined(std::string_view signature) const;
  /// Adds a line to main().
  void statement(std::string_view line);
  /// Adds a line to main() before every line that statement() has added and adds.
  void prologue(std::string_view line);
  /// Adds a line to main() of a compute program before all of these, which every invocation of a work group runs, those
  /// beside the domain, too. All have run these lines before any goes on. Then invocations are where Function::Local says.
  void together(std::string_view line);
  /// Adds a line behind all of together(): so that a group has everything fetched on its way before it keeps what has come.
  void keepTogether(std::string_view line);
  /// Takes bytes of the memory that a work group shares; false where there are not as many left.
  bool takeShared(std::size_t bytes);
  /// Adds text of skc's behind the kernel's own.
  void foreign(std::string_view text);

  /// The whole program. `comment` is its first comment line, without the slashes.
  std::string finish(const Profile& profile, std::string_view comment, const program::Kernel& kernel) const;

 private:
  struct Output {
    std::string type, name;
  };

  bool isDrawn() const { return stage_ == Stage::Fragment; }
  std::string declarationOfOutputs() const;
  std::string declarationOfBuffer() const;
  std::string mainOf(const std::string& body) const;

  Stage stage_ = Stage::Fragment;
  bool sharesTexels_ = false;
  bool samples_ = false;
  std::string place_;  ///< storeAt()'s
  bool isArray_ = false;
  bool isInBuffer_ = false;  ///< storeInBuffer()
  std::pair<std::int32_t, std::int32_t> group_{};  ///< for each texel; none: there is an invocation for each
  bool relaysUniforms_ = false;
  RelayedValues relayed_;
  std::vector<std::string> uniforms_;
  std::vector<Output> outputs_;
  std::vector<std::string> variables_;
  std::vector<std::string> signatures_;
  std::uint32_t used_ = 0;  ///< bits of Function
  std::string functions_;
  std::string together_;
  std::string keptTogether_;
  std::string prologue_;
  std::string main_;
  std::string foreign_;
  std::size_t shared_ = 0;  ///< bytes
};

/// `name(arguments)`, on one line or, where that is too long, with a line for each argument.
std::string call(std::string_view name, const std::vector<std::string>& arguments, std::string_view indent);

}  // namespace sk::assemble
