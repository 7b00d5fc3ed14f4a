// SPDX-License-Identifier: MIT
#include "frontend/tokens/parameter_editor.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include <fmt/format.h>

#include <clang/Lex/Preprocessor.h>

#include "frontend/clang_loc.hpp"
#include "frontend/prelude.hpp"
#include "frontend/tokens/parameter_parts.hpp"
#include "frontend/tokens/token_cursor.hpp"

namespace skc::frontend {

using clang::Token;
namespace tok = clang::tok;

namespace {

/// `({0, 1})` without its parentheses, which C++ does not allow there; any other value unchanged.
std::vector<Token> borderValue(const std::vector<Token>& parenthesized) {
  if (parenthesized[1].isNot(tok::l_brace)) return parenthesized;
  return {parenthesized.begin() + 1, parenthesized.end() - 1};
}

/// A fix-it that removes the tokens from `at` to the bracket `close`.
std::vector<FixIt> removal(const std::vector<Token>& tokens, std::size_t at, tok::TokenKind close) {
  for (std::size_t i = at; i < tokens.size(); ++i) {
    if (tokens[i].is(close)) return {FixIt::remove(locOf(tokens[at]), locOf(tokens[i - 1]))};
  }
  return {};
}

bool isNamedWord(const Token& token, std::initializer_list<llvm::StringRef> words) {
  for (llvm::StringRef word : words) {
    if (isWord(token, word)) return true;
  }
  return false;
}

bool isQualifier(const Token& token) {
  return isNamedWord(token, {"out", "inout", "reduce", "scan", "iter", "vout", "spec", "kernel"});
}

/// The index of the `>` that closes the list of a type, as in `sk::Scalar<float> k`; 0 for other `<`.
std::size_t endOfArguments(const std::vector<Token>& parameter, std::size_t less) {
  const std::size_t end = less > 0 ? endOfList(parameter, less) : 0;
  if (end == 0 || end + 1 >= parameter.size()) return 0;
  const Token& next = parameter[end + 1];
  const bool isArrayReference = next.is(tok::l_paren) && isKind(parameter, end + 2, tok::amp);
  const bool goesOn = next.isOneOf(tok::coloncolon, tok::amp) || next.getIdentifierInfo() || isArrayReference;
  return goesOn ? end : 0;
}

std::string repeated(std::string_view text, int times) {
  std::string result;
  for (int i = 0; i < times; ++i) result += text;
  return result;
}

}  // namespace

std::vector<Token> ParameterEditor::edit(const Tokens& declared, FunctionKind kind) {
  inputs_.clear();
  indexed_.clear();
  Tokens out{declared.front()};
  const std::vector<Tokens> parameters = splitAtCommas(declared);
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    const Token& following =
        i + 1 < parameters.size() && !parameters[i + 1].empty() ? parameters[i + 1].front() : declared.back();
    if (parameters[i].empty()) {
      diagnostics_.report(Diag::EmptyParameter, locOf(following));
      continue;
    }
    if (out.size() > 1) out.push_back(builder_.make(tok::comma, parameters[i].front().getLocation()));
    editParameter(parameters[i], kind, out);
  }
  out.push_back(declared.back());
  return out;
}

void ParameterEditor::editParameter(const Tokens& parameter, FunctionKind kind, Tokens& out) {
  ParameterParts parts;
  if (kind == FunctionKind::Helper) {
    // An ordinary parameter goes to Clang unchanged, including default arguments and templates.
    bool ours = isNamedWord(parameter.front(), {"out", "inout"}) && parameter.size() > 2;
    for (std::size_t i = 0; i + 1 < parameter.size(); ++i) {
      if (parameter[i].is(tok::l_square)) ours = true;
      if (parameter[i].is(tok::less) && parameter[i + 1].isOneOf(tok::greater, tok::greaterequal))
        ours = true;
    }
    if (!ours) {
      out.insert(out.end(), parameter.begin(), parameter.end());
      return;
    }
  }
  if (!takeParts(parameter, parts)) return;
  if (kind != FunctionKind::Helper && (parts.type.back().is(tok::amp) || parts.isArrayReference)) {
    diagnostics_.report(Diag::KernelReference, locOf(parts.type.back()), {nameOf(parts.name)});
    return;
  }
  if (kind != FunctionKind::Helper && parts.type.back().is(tok::star)) {
    diagnostics_.report(Diag::KernelPointer, locOf(parts.type.back()), {nameOf(parts.name)});
    return;
  }
  if (parts.type.size() == 1 && parts.type.back().is(tok::kw_void)) {
    diagnostics_.report(Diag::ScalarType, locOf(parts.type.back()), {"void"});
    return;
  }
  if (!resolveRole(parts, kind) || !allowsRange(parts, kind)) return;
  print(parts, kind, out);
}

/// Takes the parts of a parameter's declaration. False after an error.
bool ParameterEditor::takeParts(const Tokens& parameter, ParameterParts& parts) {
  std::size_t at = 0;
  if (!takeAttributes(parameter, at, parts)) return false;
  takeQualifier(parameter, at, parts);
  if (!takeDeclarator(parameter, at, parts)) return false;
  if (hasSecondQualifier(parts) || hasLateQualifier(parts)) return false;
  return takeSuffix(parameter, at, parts);
}

void ParameterEditor::editMember(const Tokens& declared, Tokens& out) {
  ParameterParts parts;
  if (!takeParts(declared, parts)) return;
  const std::string qualifier = parts.hasQualifier ? nameOf(parts.qualifier) : "";
  std::string_view other;
  if (qualifier == "out" || qualifier == "inout" || qualifier == "vout") {
    other = "an output";
  } else if (qualifier == "reduce" || qualifier == "scan") {
    other = "an accumulator";
  } else if (qualifier == "iter") {
    other = "an iterator";
  } else if (parts.isElement) {
    other = "an element of a stream";
  }
  if (!other.empty()) {
    diagnostics_.report(Diag::BundleMember, locOf(parts.name), {nameOf(parts.name), other});
  } else if (resolveRole(parts, FunctionKind::Kernel)) {
    print(parts, FunctionKind::Kernel, out, /*isMember=*/true);
  }
}

/// Takes a qualifier, which must precede a type and a name: `out x<>` declares a stream of type `out`.
void ParameterEditor::takeQualifier(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  const auto isWordOrScope = [&](std::size_t i) {
    return i < parameter.size() && (parameter[i].getIdentifierInfo() || parameter[i].is(tok::coloncolon));
  };
  const bool isList = isKind(parameter, at + 2, tok::less) && endOfArguments(parameter, at + 2) != 0;
  if (!isWordOrScope(at + 1) || !(isWordOrScope(at + 2) || isList)) return;
  if (isQualifier(parameter[at])) {
    parts.qualifier = parameter[at++];
    parts.hasQualifier = true;
  }
}

/// Takes the type and the name: the last identifier before `<>`, `[`, `=` or the end.
bool ParameterEditor::takeDeclarator(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  const std::size_t begin = at;
  std::size_t end = parameter.size();
  for (std::size_t i = begin; i < parameter.size(); ++i) {
    const bool isLess = parameter[i].is(tok::less);
    const bool isEmpty =
        isLess && (i + 1 == parameter.size() || parameter[i + 1].isOneOf(tok::greater, tok::greaterequal));
    if (const std::size_t close = isLess && !isEmpty ? endOfArguments(parameter, i) : 0; close != 0) {
      i = close;
      continue;
    }
    const bool stream = isEmpty || (isLess && i > begin + 1 && parameter[i - 1].is(tok::identifier));
    if (stream || parameter[i].isOneOf(tok::l_square, tok::equal)) {
      end = i;
      break;
    }
  }
  // `T (&w)[9]`
  if (end > begin + 4 && end < parameter.size() && parameter[end - 1].is(tok::r_paren) &&
      parameter[end - 2].is(tok::identifier) && parameter[end - 3].is(tok::amp) &&
      parameter[end - 4].is(tok::l_paren)) {
    parts.type.assign(parameter.begin() + static_cast<std::ptrdiff_t>(begin),
                      parameter.begin() + static_cast<std::ptrdiff_t>(end) - 4);
    parts.name = parameter[end - 2];
    parts.isArrayReference = true;
    at = end;
    return true;
  }
  if (end < begin + 2 || parameter[end - 1].isNot(tok::identifier)) {
    const Token& location = begin < parameter.size() ? parameter[begin] : parameter.back();
    diagnostics_.report(Diag::ParameterShape, locOf(location));
    return false;
  }
  parts.type.assign(parameter.begin() + static_cast<std::ptrdiff_t>(begin),
                    parameter.begin() + static_cast<std::ptrdiff_t>(end) - 1);
  parts.name = parameter[end - 1];
  at = end;
  return true;
}

/// True for `out reduce float r<>`, with a fix-it that removes the first qualifier.
bool ParameterEditor::hasSecondQualifier(const ParameterParts& parts) {
  if (!parts.hasQualifier || parts.type.size() < 2 || !isQualifier(parts.type.front())) return false;
  diagnostics_.report(Diag::QualifierTwice, locOf(parts.qualifier),
                      {nameOf(parts.qualifier), nameOf(parts.type.front()), nameOf(parts.name)},
                      {FixIt::remove(locOf(parts.qualifier), locOf(parts.qualifier))});
  return true;
}

/// True for `float out r<>`, whose author meant `out float r<>`.
bool ParameterEditor::hasLateQualifier(const ParameterParts& parts) {
  const Token& last = parts.type.back();
  if (parts.hasQualifier || parts.type.size() < 2 || !isQualifier(last)) return false;
  const Token& before = parts.type[parts.type.size() - 2];
  if (before.isOneOf(tok::coloncolon, tok::kw_const, tok::kw_struct)) return false;
  std::string reordered = nameOf(last);
  for (auto token = parts.type.begin(); token + 1 != parts.type.end(); ++token)
    reordered += " " + preprocessor_.getSpelling(*token);
  diagnostics_.report(Diag::QualifierOrder, locOf(last), {nameOf(last), nameOf(parts.name)},
                      {FixIt::replace(locOf(parts.type.front()), locOf(last), std::move(reordered))});
  return true;
}

bool ParameterEditor::takeSuffix(const Tokens& parameter, std::size_t& at, ParameterParts& parts) {
  const std::string name = nameOf(parts.name);
  bool equal = false;
  if (isKind(parameter, at, tok::less)) {
    parts.open = parameter[at++];
    if (!isKind(parameter, at, tok::greater) && !isKind(parameter, at, tok::greaterequal)) {
      const Token& location = at < parameter.size() ? parameter[at] : parameter.back();
      const std::vector<FixIt> fixIts = removal(parameter, at, tok::greater);
      diagnostics_.report(Diag::StreamBrackets, locOf(location), {name}, fixIts);
      return false;
    }
    parts.close = parameter[at];
    equal = parameter[at++].is(tok::greaterequal);   // `total<>= 0` lexes as < >= 0
    parts.isElement = true;
  }
  while (isKind(parameter, at, tok::l_square)) {
    const Token& bracket = parameter[at++];
    if (!isKind(parameter, at, tok::r_square)) {
      const bool closed = std::any_of(parameter.begin() + static_cast<std::ptrdiff_t>(at), parameter.end(),
                                      [](const Token& token) { return token.is(tok::r_square); });
      if (!closed || parts.rank > 0) {
        diagnostics_.report(Diag::GatherBrackets, locOf(bracket), {name},
                            removal(parameter, at, tok::r_square));
        return false;
      }
      ++parts.lengths;
      parts.length.push_back(bracket);
      for (int depth = 1; depth > 0 && at < parameter.size(); ++at) {
        if (parameter[at].is(tok::l_square)) ++depth;
        if (parameter[at].is(tok::r_square)) --depth;
        parts.length.push_back(parameter[at]);
      }
      continue;
    }
    parts.close = parameter[at++];
    if (parts.rank++ == 0) parts.open = bracket;
  }
  if (!equal && isKind(parameter, at, tok::equal)) {
    equal = true;
    ++at;
  }
  if (equal) {
    parts.value.assign(parameter.begin() + static_cast<std::ptrdiff_t>(at), parameter.end());
    at = parameter.size();
    if (parts.value.empty()) {
      diagnostics_.report(Diag::IdentityValue, locOf(parameter.back()), {name});
      return false;
    }
  }
  if (at < parameter.size()) {
    diagnostics_.report(Diag::ParameterExtra, locOf(parameter[at]),
                        {preprocessor_.getSpelling(parameter[at]), name});
    return false;
  }
  return true;
}

/// A fix-it that adds `<>` after the name of a parameter without brackets.
std::vector<FixIt> ParameterEditor::addedBrackets(const ParameterParts& parts) {
  if (parts.rank > 0 || parts.isElement || !parts.length.empty()) return {};
  return {FixIt::insertAfter(locOf(parts.name), "<>")};
}

/// A fix-it that removes the `<>` of a parameter that has no other brackets.
std::vector<FixIt> ParameterEditor::removedBrackets(const ParameterParts& parts) {
  if (!parts.isElement || parts.rank > 0) return {};
  return {FixIt::remove(locOf(parts.open), locOf(parts.close))};
}

/// A fix-it that changes the qualifier to this one of accumulators, for a parameter that is one otherwise.
std::vector<FixIt> ParameterEditor::asAccumulator(const ParameterParts& parts, std::string_view word) {
  if (!parts.isElement || parts.rank > 0) return {};
  return {FixIt::replace(locOf(parts.qualifier), std::string(word))};
}

/// Derives the role from qualifier, `<>` and brackets together, as the language's table of parameters says.
bool ParameterEditor::resolveRole(ParameterParts& parts, FunctionKind kind) {
  const std::string name = nameOf(parts.name);
  const Loc location = locOf(parts.name);
  const auto fail = [&](Diag diag, std::initializer_list<std::string_view> arguments,
                        const std::vector<FixIt>& fixIts = {}) {
    diagnostics_.report(diag, location, arguments, fixIts);
    return false;
  };
  const std::string qualifier = parts.hasQualifier ? nameOf(parts.qualifier) : "";
  if (qualifier == "kernel") {
    diagnostics_.report(Diag::QualifierUnknown, locOf(parts.qualifier), {qualifier});
    return false;
  }
  if (parts.lengths > 1) {
    const std::string brackets = repeated("[]", parts.lengths);
    return fail(Diag::ArrayOfLengths, {name, std::to_string(parts.lengths), brackets});
  }
  const bool isReference =
      kind == FunctionKind::Helper && (qualifier == "out" || qualifier == "inout") && !parts.isArrayReference;
  if (!parts.length.empty() &&
      (parts.isElement || parts.rank > 0 || parts.hasAttribute || !(qualifier.empty() || isReference))) {
    return fail(Diag::ArrayParameter, {name});
  }
  if (parts.isElement && parts.rank > 0) return fail(Diag::StreamAndGather, {name});
  const bool isAppendOutput = qualifier == "vout" || (qualifier == "out" && parts.rank > 0);
  if (isAppendOutput) return resolveAppendOutput(parts, kind);
  if (parts.rank > 4) return fail(Diag::StreamRank, {name, std::to_string(parts.rank)});
  const bool isOfAlias = parts.border.empty() && !parts.isElement && mayBeAlias(parts.type);
  const bool isGather = parts.rank > 0 || gatherIn(parts.type) || isOfAlias;
  if (parts.hasAttribute && (!isGather || !qualifier.empty())) {
    diagnostics_.report(Diag::BoundaryWithoutGather, locOf(parts.attribute), {nameOf(parts.attribute), name});
    return false;
  }
  const bool isAccumulator = qualifier == "reduce" || qualifier == "scan";
  if (!parts.value.empty() && !isAccumulator) return fail(Diag::DefaultArgument, {name});
  if (qualifier == "iter" || qualifier == "spec") {
    if (kind == FunctionKind::Helper) {
      diagnostics_.report(Diag::QualifierOutsideKernel, locOf(parts.qualifier), {qualifier, name});
      return false;
    }
    const bool isIterator = qualifier == "iter";
    if (parts.rank > 0 || parts.isElement != isIterator) {
      return fail(isIterator ? Diag::IteratorBrackets : Diag::SpecBrackets, {name},
                  isIterator ? addedBrackets(parts) : removedBrackets(parts));
    }
    parts.syntax.role = isIterator ? ir::ParamRole::Iterator : ir::ParamRole::Spec;
    return true;
  }
  if (kind == FunctionKind::Helper) {
    if (parts.isElement) return fail(Diag::StreamInHelper, {name}, removedBrackets(parts));
    if (parts.rank > 0 && !qualifier.empty()) return fail(Diag::OutputBrackets, {name});
    parts.syntax.role = parts.rank > 0      ? ir::ParamRole::Gather
                        : qualifier.empty() ? ir::ParamRole::Uniform
                                            : ir::ParamRole::Output;
  } else if (qualifier == "out" || qualifier == "inout") {
    if (isFold(kind))
      return fail(Diag::OutputInReduce, {name, wordOf(kind)}, asAccumulator(parts, wordOf(kind)));
    if (qualifier == "inout") return fail(Diag::InoutStream, {name});
    if (!parts.isElement) return fail(Diag::OutputBrackets, {name}, addedBrackets(parts));
    parts.syntax.role = ir::ParamRole::Output;
  } else if (isAccumulator) {
    if (!parts.isElement) return fail(Diag::AccumulatorBrackets, {name, qualifier}, addedBrackets(parts));
    const std::string_view word = isFold(kind) ? wordOf(kind) : wordOf(FunctionKind::Reduce);
    if (qualifier != word) {
      return fail(Diag::AccumulatorOfOther, {name, word, wordOf(kind)}, asAccumulator(parts, word));
    }
    parts.syntax.role = ir::ParamRole::Accumulator;
  } else {
    parts.syntax.role = parts.isElement  ? ir::ParamRole::Input
                        : parts.rank > 0 ? ir::ParamRole::Gather
                                         : ir::ParamRole::Uniform;
  }
  parts.syntax.rank = static_cast<std::uint8_t>(parts.rank);
  return true;
}

/// Reports a [[range]] where nothing checks it.
bool ParameterEditor::allowsRange(const ParameterParts& parts, FunctionKind kind) {
  const bool isIterator = parts.syntax.role == ir::ParamRole::Iterator;
  if (parts.ends.empty() || (kind != FunctionKind::Helper && !isIterator)) return true;
  diagnostics_.report(Diag::RangePlace, locOf(parts.range),
                      {nameOf(parts.name),
                       isIterator ? "an iterator, whose ends each call gives" : "a parameter of a function"});
  return false;
}

/// `vout T r<>` and `out T r[]`, in kernels and in the functions to which they pass theirs.
bool ParameterEditor::resolveAppendOutput(ParameterParts& parts, FunctionKind kind) {
  const std::string name = nameOf(parts.name);
  const auto fail = [&](Diag diag, std::initializer_list<std::string_view> arguments,
                        const std::vector<FixIt>& fixIts = {}) {
    diagnostics_.report(diag, locOf(parts.name), arguments, fixIts);
    return false;
  };
  const bool isVariable = nameOf(parts.qualifier) == "vout";
  if (isFold(kind)) return fail(Diag::OutputInReduce, {name, wordOf(kind)});
  if (isVariable && (!parts.isElement || parts.rank > 0)) {
    return fail(Diag::VariableOutputBrackets, {name}, addedBrackets(parts));
  }
  if (parts.isElement && !isVariable) return fail(Diag::StreamAndGather, {name});
  if (parts.rank > 4) return fail(Diag::StreamRank, {name, std::to_string(parts.rank)});
  if (parts.hasAttribute) {
    diagnostics_.report(Diag::BoundaryWithoutGather, locOf(parts.attribute), {nameOf(parts.attribute), name});
    return false;
  }
  if (!parts.value.empty()) return fail(Diag::DefaultArgument, {name});
  parts.syntax.role = isVariable ? ir::ParamRole::VariableOutput : ir::ParamRole::Scatter;
  parts.syntax.rank = static_cast<std::uint8_t>(parts.rank);
  return true;
}

void ParameterEditor::print(const ParameterParts& parts, FunctionKind kind, Tokens& out, bool isMember) {
  const clang::SourceLocation location = parts.name.getLocation();
  ParamSyntax syntax = parts.syntax;
  if (kind == FunctionKind::Helper) {
    syntax.boundary = ir::Boundary::Clamp;   // the mode is that of the kernel's gather
  } else if (!parts.border.empty()) {
    syntax.border = generateConstant(elementTypeOf(parts.type), borderValue(parts.border), location);
  }
  if (parts.hasAttribute) syntax.attribute = nameOf(parts.attribute);
  if (!parts.ends.empty()) {
    // 1e-300 is no float, and 1.5 no int, which is for lowering to say
    const bool isDouble = nameOf(elementTypeOf(parts.type).back()).starts_with("double");
    const Tokens type{builder_.word(isDouble ? "double" : "auto", location)};
    syntax.range = {generateConstant(type, parts.ends.front(), parts.ends.front().front().getLocation()),
                    generateConstant(type, parts.ends.back(), parts.ends.back().front().getLocation())};
  }
  if (!parts.value.empty()) syntax.identity = generateConstant(parts.type, parts.value, location);
  if (syntax.rank > 0) indexed_.push_back({parts.name, syntax.rank});
  const clang::SourceLocation start = parts.type.front().getLocation();
  switch (syntax.role) {
    case ir::ParamRole::Gather:
      // The three tokens need distinct locations: Clang finds a template's name by its location
      out.push_back(builder_.word(gatherTemplateName(syntax.rank), location));
      out.push_back(builder_.make(tok::less, parts.open.getLocation()));
      for (const Token& token : parts.type) {
        // Nobody writes to elements: `const float a[]` is the same gather.
        const bool isAtEnd = &token == &parts.type.front() || &token == &parts.type.back();
        if (!isAtEnd || token.isNot(tok::kw_const)) out.push_back(token);
      }
      out.push_back(builder_.make(tok::greater, parts.close.getLocation()));
      break;
    case ir::ParamRole::VariableOutput:
    case ir::ParamRole::Scatter:
      out.push_back(builder_.word(appendTemplateName(syntax.rank), location));
      out.push_back(builder_.make(tok::less, parts.open.getLocation()));
      out.insert(out.end(), parts.type.begin(), parts.type.end());
      out.push_back(builder_.make(tok::greater, parts.close.getLocation()));
      break;
    case ir::ParamRole::Output:
    case ir::ParamRole::Accumulator:
      out.insert(out.end(), parts.type.begin(), parts.type.end());
      if (parts.length.empty()) out.push_back(builder_.make(tok::amp, location));
      break;
    case ir::ParamRole::Input: inputs_.push_back({parts.type.front(), parts.name}); [[fallthrough]];
    case ir::ParamRole::Uniform:
    case ir::ParamRole::Iterator:
    case ir::ParamRole::Spec:
      // of an input of a pipeline that is an output of a kernel, lowering says more than Clang
      if (!isMember && parts.type.front().isNot(tok::kw_const) && !parts.isArrayReference &&
          !(kind == FunctionKind::Pipeline && syntax.role == ir::ParamRole::Input))
        out.push_back(builder_.word("const", start));
      out.insert(out.end(), parts.type.begin(), parts.type.end());
      break;
  }
  if (parts.length.empty() || isMember) {
    out.push_back(parts.name);
    out.insert(out.end(), parts.length.begin(), parts.length.end());
  } else {   // a reference, since C++ cannot pass arrays by value
    out.push_back(builder_.make(tok::l_paren, location));
    out.push_back(builder_.make(tok::amp, location));
    out.push_back(parts.name);
    out.push_back(builder_.make(tok::r_paren, location));
    out.insert(out.end(), parts.length.begin(), parts.length.end());
  }
  const bool isByIndex = syntax.role == ir::ParamRole::Gather || syntax.role == ir::ParamRole::Scatter ||
                         syntax.role == ir::ParamRole::VariableOutput || parts.hasAttribute;
  if (kind != FunctionKind::Helper || isByIndex) {
    syntax_.add(location, std::move(syntax));
  }
}

/// The constant goes to the start of a kernel's body, or in front of a helper function.
std::string ParameterEditor::generateConstant(const Tokens& type, const Tokens& value,
                                              clang::SourceLocation location) {
  std::string name = fmt::format("__sk_constant{}", constants_++);
  builder_.constant(name, type, value, location, before_);
  return name;
}

}  // namespace skc::frontend
