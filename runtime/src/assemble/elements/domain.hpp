// SPDX-License-Identifier: MIT
//
// Where an invocation is in its domain: the index and the number of the element that it computes, as
// GLSL expressions. Declares what they need when they are first asked for; ends invocations
// outside a box before main() does anything else.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// How the texels of a domain lie.
struct DomainLayout {
  Domain domain = Domain::Plane;
  bool view = false;
  int rank = 2;  ///< of the domain's stream, where that is linearised
  bool layered = false;
  bool packed = false;  ///< an invocation computes the four elements of a texel, one after the other
};

class DomainText {
 public:
  /// `function`: what index() calls.
  DomainText(ProgramText& program, const DomainLayout& layout, std::string_view function = "sk_index");

  /// Which of the four elements of a packed texel is computed, an int expression: main() has to set it.
  std::string lane();
  bool usesLane() const { return usesLane_; }
  /// A call of the function, which gives an ivec4.
  std::string index();
  /// The first components of the index: an int or an ivec2 to ivec4 expression.
  std::string position(int components);
  /// The texel that is computed.
  Texel texel();
  /// That texel's number, linearised: an int expression that wants brackets.
  std::string texelNumber();
  /// The element's row-major number in the domain: an int expression without the need of brackets
  /// as an operand of `=`. A box of a linearised stream is numbered by `sk_domain_step`, the strides
  /// that a whole stream of its shape has.
  std::string number();
  /// Makes main() end at once for fragments outside the domain. GPUs shade whole quads of 2 x 2, so that
  /// such fragments run, as helper invocations, wherever a drawn rectangle has an odd edge. They write
  /// nothing, but a loop may never end on what they read.
  void leaveOutside();

 private:
  bool isDrawn() const { return program_.stage() == Stage::Fragment; }
  void defineIndex();
  std::string firstElement();
  std::string plus(std::string index, int components);
  std::string_view inElements() const { return layout_.packed ? " * ivec2(4, 1)" : ""; }

  ProgramText& program_;
  DomainLayout layout_;
  bool usesLane_ = false;
  std::string_view function_;
};

}  // namespace sk::assemble
