// SPDX-License-Identifier: MIT
//
// Where an invocation is in its domain: the index and the number of the element that it computes, as
// GLSL expressions. Declares what they need when they are first asked for; ends invocations
// outside a box before main() does anything else.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/planes.hpp"
#include "assemble/program_text.hpp"

namespace sk::assemble {

class DomainText {
 public:
  /// `rank`: of the domain's stream, for domains of linearised streams. `layered`: what is drawn to are layers.
  /// `function`: what index() calls.
  DomainText(ProgramText& program, Domain domain, bool view, int rank, bool layered,
             std::string_view function = "sk_index");

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

  ProgramText& program_;
  Domain domain_;
  bool view_;
  int rank_;
  bool layered_;
  std::string_view function_;
};

}  // namespace sk::assemble
