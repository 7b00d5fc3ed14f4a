// SPDX-License-Identifier: MIT
//
// Kernels for operations with scalars, written when a sequence of operations is first carried out. Parameters are a Uniform for
// each read and number of the pass, then an Output for each of its outputs, in order.
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/program/made_kernels.hpp"
#include "sk/arithmetic_marks.hpp"
#include "sk/scalar_bytes.hpp"

namespace sk {

namespace {

using detail::ScalarOp;
using program::Intrinsic;
using program::Parameter;
using program::Role;
namespace mark = program::mark;

/// What kernels' text has for divisions (compiler/glsl), too. Floats are compared as integers: some compilers make
/// a >= b of !(a < b), which is false for NaN.
constexpr std::string_view helpers =
    "bool sk_ordered(float a, float b) {\n"
    "  return max(floatBitsToUint(a) & 0x7fffffffu, floatBitsToUint(b) & 0x7fffffffu) <= 0x7f800000u;\n"
    "}\n"
    "int sk_key(float x) {\n"
    "  int i = floatBitsToInt(x);\n"
    "  return i < 0 ? (-2147483647 - 1) - i : i;\n"
    "}\n"
    "int sk_div(int a, int b) {\n"
    "  int d = b == 0 || (b == -1 && a == -2147483647 - 1) ? 1 : b;\n"
    "  return a / d;\n"
    "}\n"
    "uint sk_div(uint a, uint b) { return a / (b == 0u ? 1u : b); }\n";
constexpr std::string_view doubleHelpers =
    "bool sk_ordered(sk_double a, sk_double b) { return !sk_isnan(a) && !sk_isnan(b); }\n"
    "sk_double sk_max(sk_double a, sk_double b) { return sk_less(a, b) || sk_isnan(a) ? b : a; }\n"
    "sk_double sk_min(sk_double a, sk_double b) { return sk_less(b, a) || sk_isnan(a) ? b : a; }\n";

constexpr std::string_view longHelpers =
    "sk_long sk_abs(sk_long a) { return sk_choose(sk_less(a, sk_to_long(0)), sk_neg(a), a); }\n"
    "sk_long sk_max(sk_long a, sk_long b) { return sk_choose(sk_less(a, b), b, a); }\n"
    "sk_long sk_min(sk_long a, sk_long b) { return sk_choose(sk_less(b, a), b, a); }\n"
    "sk_ulong sk_max(sk_ulong a, sk_ulong b) { return sk_choose(sk_less(a, b), b, a); }\n"
    "sk_ulong sk_min(sk_ulong a, sk_ulong b) { return sk_choose(sk_less(b, a), b, a); }\n";

/// The GLSL of an operation on doubles or on integers of 64 bits, which are structs there.
std::string_view patternOfWide(ScalarOp op, program::Scalar type) {
  if (type != program::Scalar::Double) {
    if (op == ScalarOp::Less) return "sk_less({0}, {1})";
    if (op == ScalarOp::LessEqual) return "!sk_less({1}, {0})";
    if (op == ScalarOp::Equal) return "sk_equal({0}, {1})";
  }
  switch (op) {
    case ScalarOp::Copy: return "{0}";
    case ScalarOp::Negate: return "sk_neg({0})";
    case ScalarOp::Absolute: return "sk_abs({0})";
    case ScalarOp::SquareRoot: return "sk_sqrt({0})";
    case ScalarOp::Add: return "sk_add({0}, {1})";
    case ScalarOp::Subtract: return "sk_sub({0}, {1})";
    case ScalarOp::Multiply: return "sk_mul({0}, {1})";
    case ScalarOp::Divide: return "sk_div({0}, {1})";
    case ScalarOp::Minimum: return "sk_min({0}, {1})";
    case ScalarOp::Maximum: return "sk_max({0}, {1})";
    case ScalarOp::Less: return "sk_ordered({0}, {1}) && sk_less({0}, {1})";
    case ScalarOp::LessEqual: return "sk_ordered({0}, {1}) && sk_less_equal({0}, {1})";
    case ScalarOp::Equal: return "sk_ordered({0}, {1}) && sk_equal({0}, {1})";
    case ScalarOp::Select: return "sk_choose({0}, {1}, {2})";
    case ScalarOp::Not:
    case ScalarOp::And:
    case ScalarOp::Or: break;  // of bools only
  }
  return {};
}

std::string_view patternOf(ScalarOp op, program::Scalar type) {
  if (program::is64Bit(type)) return patternOfWide(op, type);
  if (type == program::Scalar::Float) {
    switch (op) {
      case ScalarOp::Less: return "sk_ordered({0}, {1}) && sk_key({0}) < sk_key({1})";
      case ScalarOp::LessEqual: return "sk_ordered({0}, {1}) && sk_key({0}) <= sk_key({1})";
      case ScalarOp::Equal: return "sk_ordered({0}, {1}) && sk_key({0}) == sk_key({1})";
      default: break;
    }
  }
  const bool isFloat = type == program::Scalar::Float;
  switch (op) {
    case ScalarOp::Copy: return "{0}";
    case ScalarOp::Negate: return "-{0}";
    case ScalarOp::Absolute: return "abs({0})";
    case ScalarOp::SquareRoot: return "sqrt({0})";
    case ScalarOp::Not: return "!{0}";
    case ScalarOp::Add: return "{0} + {1}";
    case ScalarOp::Subtract: return "{0} - {1}";
    case ScalarOp::Multiply: return "{0} * {1}";
    case ScalarOp::Divide: return isFloat ? "{0} / $/{1}$|" : "sk_div({0}, {1})";
    case ScalarOp::Minimum: return isFloat ? "sk_min({0}, {1})" : "min({0}, {1})";
    case ScalarOp::Maximum: return isFloat ? "sk_max({0}, {1})" : "max({0}, {1})";
    case ScalarOp::Less: return "{0} < {1}";
    case ScalarOp::LessEqual: return "{0} <= {1}";
    case ScalarOp::Equal: return "{0} == {1}";
    case ScalarOp::And: return "{0} && {1}";
    case ScalarOp::Or: return "{0} || {1}";
    case ScalarOp::Select: return "{0} ? {1} : {2}";
  }
  return {};
}

/// Whether it computes in floats, as kernels do: it is marked (sk/arithmetic_marks.hpp), so that compilers neither reorder it nor
/// take what another one undoes for its operand.
bool computesFloats(const ScalarStep& step) {
  if (step.type != program::Scalar::Float) return false;
  switch (step.op) {
    case ScalarOp::Add:
    case ScalarOp::Subtract:
    case ScalarOp::Multiply:
    case ScalarOp::Divide:
    case ScalarOp::SquareRoot: return true;
    default: return false;
  }
}

class KernelText {
 public:
  explicit KernelText(const ScalarPass& pass) : pass_(pass) {}

  std::shared_ptr<const MadeKernel> make() && {
    for (std::size_t i = 0; i < pass_.reads.size(); ++i)
      add("r", i, Role::Uniform, *pass_.reads[i].stream->element);
    for (std::size_t i = 0; i < pass_.numbers.size(); ++i)
      add("n", i, Role::Uniform, *pass_.numbers[i].element);
    for (std::size_t i = 0; i < pass_.outputs.size(); ++i) {
      add("o", i, Role::Output, *pass_.steps[pass_.outputs[i].step].result);
    }
    made_->body = text();
    made_->kernel = {.name = "scalars",
                     .entry = "scalars",
                     .declarations = {},
                     .body = made_->body,
                     .parameters = made_->parameters,
                     .sources = {},
                     .usesDoubles = usesDoubles_,
                     .usesLongs = usesLongs_,
                     .intrinsics = intrinsics};
    return std::move(made_);
  }

 private:
  static constexpr program::IntrinsicUse intrinsics[] = {{Intrinsic::Max, 1}, {Intrinsic::Min, 1}};

  void add(std::string_view prefix, std::size_t number, Role role, const program::Element& element) {
    const std::string_view name = made_->own(fmt::format("{}{}", prefix, number));
    made_->parameters.push_back(
        {.name = name, .symbol = name, .role = role, .element = &made_->own(element)});
    const program::Scalar scalar = element.fields.front().scalar;
    usesDoubles_ = usesDoubles_ || scalar == program::Scalar::Double;
    usesLongs_ = usesLongs_ || scalar == program::Scalar::Long || scalar == program::Scalar::Ulong;
  }

  std::string text() const {
    std::string list;
    for (const Parameter& parameter : made_->parameters) {
      list += fmt::format("{}{}{} {}", list.empty() ? "" : ", ", parameter.role == Role::Output ? "out " : "",
                          parameter.element->glsl, parameter.name);
    }
    std::string body(helpers);
    if (usesDoubles_) body += doubleHelpers;
    if (usesLongs_) body += longHelpers;
    body += fmt::format("void scalars({}) {{\n", list);
    for (std::size_t i = 0; i < pass_.steps.size(); ++i) {
      const ScalarStep& step = pass_.steps[i];
      const bool isMarked = computesFloats(step);
      std::string first = nameOf(step.operands[0]);
      const std::string second = nameOf(step.operands[1]);
      if (isMarked && first == second) first = fmt::format("{}{}{}", mark::known, first, mark::knownEnd);
      const std::string value =
          fmt::format(fmt::runtime(patternOf(step.op, step.type)), first, second, nameOf(step.operands[2]));
      body += isMarked ? fmt::format("  {}float s{} = {}{}{};\n", mark::declared, i, mark::operation, value,
                                     mark::operationEnd)
                       : fmt::format("  {} s{} = {};\n", step.result->glsl, i, value);
    }
    for (std::size_t i = 0; i < pass_.outputs.size(); ++i) {
      body += fmt::format("  o{} = s{};\n", i, pass_.outputs[i].step);
    }
    return body + "}\n";
  }

  static std::string nameOf(const ScalarRef& ref) {
    switch (ref.kind) {
      case ScalarRef::Kind::Read: return fmt::format("r{}", ref.index);
      case ScalarRef::Kind::Number: return fmt::format("n{}", ref.index);
      case ScalarRef::Kind::Step: break;
    }
    return fmt::format("s{}", ref.index);
  }

  const ScalarPass& pass_;
  std::shared_ptr<MadeKernel> made_ = std::make_shared<MadeKernel>();
  bool usesDoubles_ = false, usesLongs_ = false;
};

/// A pass with its kernel.
class PreparedScalars final : public RecordedCall {
 public:
  PreparedScalars(GlDevice& device, ScalarPass pass)
      : device_(device),
        pass_(std::move(pass)),
        kernel_(device.programs().scalarKernels().keep(KernelText(pass_).make())) {
    device.checkProgram(kernel_->kernel);
    for (const StreamRegion& read : pass_.reads) arguments_.push_back({.region = read});
    for (const ScalarPass::Number& number : pass_.numbers)
      arguments_.push_back({.value = number.value.data()});
    for (const ScalarPass::Output& output : pass_.outputs) {
      const Shape& shape = output.stream->shape;
      arguments_.push_back({.region = {output.stream, Index::origin(shape.rank()), shape}});
    }
  }

  void run() override { device_.runUnchecked(resolveCall(kernel_->kernel, arguments_, device_.limits)); }
  std::string_view name() const override { return operationsName; }

 private:
  GlDevice& device_;
  const ScalarPass pass_;
  const std::shared_ptr<const MadeKernel> kernel_;
  std::vector<Argument> arguments_;
};

}  // namespace

std::unique_ptr<RecordedCall> GlDevice::prepareScalars(ScalarPass pass) {
  return std::make_unique<PreparedScalars>(*this, std::move(pass));
}

}  // namespace sk
