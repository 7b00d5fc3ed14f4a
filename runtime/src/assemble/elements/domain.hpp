// SPDX-License-Identifier: MIT
//
// The position of an invocation in its domain: index and number of its element, as GLSL expressions. Adds the
// declarations they need on first use; ends invocations outside a box before main() does anything else.
#pragma once

#include <string>
#include <string_view>

#include "assemble/assemble.hpp"
#include "assemble/elements/planes.hpp"
#include "assemble/glsl/program_text.hpp"

namespace sk::assemble {

/// The layout of a domain's texels.
struct DomainLayout {
  Domain domain = Domain::Plane;
  bool view = false;
  int rank = 2;  ///< of the domain's stream, if that is linearised
  bool layered = false;
  bool packed = false;  ///< an invocation computes the four elements of a texel in sequence
  bool placed = false;  ///< a part of a whole
};

class DomainText {
 public:
  /// `function` is the name of the function that index() calls.
  DomainText(ProgramText& program, const DomainLayout& layout, std::string_view function = "sk_index");

  /// The current one of the four elements of a packed texel, an int expression that main() must set.
  std::string lane();
  bool usesLane() const { return usesLane_; }
  /// A call of the function, which returns an ivec4.
  std::string index();
  /// The index that the kernel sees: in a placed domain, a call of sk_index(), which counts in the whole.
  std::string seenIndex();
  /// The extents that the kernel sees, an ivec4.
  std::string seenShape();
  /// The first components of seenIndex(): an int or an ivec2 to ivec4 expression.
  std::string seenPosition(int components);
  /// The first components of the index: an int or an ivec2 to ivec4 expression.
  std::string position(int components);
  /// Planes, packed: the first components of the texel's index in the domain, an int or an ivec2 expression.
  std::string texelPosition(int components);
  /// The invocation's texel.
  Texel texel();
  /// The number of that texel in a linearised stream: an int expression that needs parentheses.
  std::string texelNumber();
  /// The element's row-major number in the domain: an int expression that needs no parentheses as the right
  /// side of `=`. A box of a linearised stream is numbered with `sk_domain_step`, the strides of a whole
  /// stream of its shape.
  std::string number();
  /// Makes main() return immediately in fragments outside the domain. GPUs shade quads of 2 x 2, so that such
  /// fragments run as helper invocations along odd edges of a drawn rectangle. They write nothing, but
  /// undefined inputs might keep a loop from ending.
  void leaveOutside();

 private:
  bool isDrawn() const { return program_.stage() == Stage::Fragment; }
  bool isStrided() const { return layout_.domain >= Domain::Strided; }
  void defineIndex();
  void defineStridedIndex();
  std::string firstElement();
  std::string plus(std::string index, int components);
  std::string_view inElements() const { return layout_.packed ? " * ivec2(4, 1)" : ""; }

  ProgramText& program_;
  DomainLayout layout_;
  bool usesLane_ = false;
  std::string_view function_;
};

}  // namespace sk::assemble
