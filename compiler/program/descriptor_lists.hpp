// SPDX-License-Identifier: MIT
//
// The members of every descriptor of sk/program.hpp, by name, for what prints descriptors as data. A descriptor with a
// member that is missing here does not compile.
#pragma once

#include <array>
#include <cstddef>
#include <string_view>
#include <tuple>

#include "program/member_count.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// A member that is printed under its name.
template <class T, class M>
struct Member {
  std::string_view name;
  M T::* pointer;
  static constexpr std::size_t count = 1;
};

/// An array that a descriptor has as two members, a pointer and a number.
template <class T, class M, class N>
struct CountedMember {
  std::string_view name;
  const M* T::* first;
  N T::* number;
  static constexpr std::size_t count = 2;
};

/// A member that is not printed, because it only has a meaning in C++ or is the same in all descriptors of a file.
template <class T, class M>
struct OmittedMember {
  M T::* pointer;
  static constexpr std::size_t count = 1;
};

/// `Members<T>::list` is a tuple of the members of T.
template <class T>
struct Members;

template <class T>
constexpr bool listsAll = std::apply([](const auto&... member) { return (member.count + ...); },
                                     Members<T>::list) == memberCount<T>();

/// `enumerators<E>` has the name of each enumerator of E, in order.
template <class E>
constexpr std::array<std::string_view, 0> enumerators;

namespace p = sk::program;

template <>
struct Members<p::Field> {
  static constexpr std::tuple list{
      Member{"path", &p::Field::path},   Member{"scalar", &p::Field::scalar},
      Member{"width", &p::Field::width}, Member{"offset", &p::Field::offset},
      Member{"part", &p::Field::part},
  };
};

template <>
struct Members<p::Element> {
  static constexpr std::tuple list{
      Member{"name", &p::Element::name},
      Member{"glsl", &p::Element::glsl},
      Member{"size", &p::Element::size},
      Member{"fields", &p::Element::fields},
  };
};

template <>
struct Members<p::ConditionStep> {
  static constexpr std::tuple list{
      Member{"op", &p::ConditionStep::op},
      Member{"scalar", &p::ConditionStep::scalar},
      Member{"value", &p::ConditionStep::value},
  };
};

template <>
struct Members<p::Condition> {
  static constexpr std::tuple list{
      Member{"steps", &p::Condition::steps},
      Member{"text", &p::Condition::text},
  };
};

template <>
struct Members<p::Layer> {
  static constexpr std::tuple list{
      Member{"bundle", &p::Layer::bundle},
      Member{"layer", &p::Layer::layer},
      Member{"count", &p::Layer::count},
  };
};

template <>
struct Members<p::Distance> {
  static constexpr std::tuple list{
      Member{"constant", &p::Distance::constant},
      Member{"perSpec", &p::Distance::perSpec},
  };
};

template <>
struct Members<p::Reach> {
  static constexpr std::tuple list{
      Member{"dimension", &p::Reach::dimension},
      Member{"kind", &p::Reach::kind},
      Member{"below", &p::Reach::below},
      Member{"above", &p::Reach::above},
      Member{"isPromised", &p::Reach::isPromised},
  };
};

template <>
struct Members<p::Parameter> {
  static constexpr std::tuple list{
      Member{"name", &p::Parameter::name},
      Member{"symbol", &p::Parameter::symbol},
      Member{"role", &p::Parameter::role},
      Member{"element", &p::Parameter::element},
      Member{"held", &p::Parameter::held},
      Member{"rank", &p::Parameter::rank},
      Member{"boundary", &p::Parameter::boundary},
      Member{"border", &p::Parameter::border},
      Member{"identity", &p::Parameter::identity},
      Member{"scatter", &p::Parameter::scatter},
      Member{"pushes", &p::Parameter::pushes},
      Member{"usesIndex", &p::Parameter::usesIndex},
      Member{"usesExtent", &p::Parameter::usesExtent},
      Member{"usesAt", &p::Parameter::usesAt},
      Member{"usesNear", &p::Parameter::usesNear},
      Member{"usesSample", &p::Parameter::usesSample},
      Member{"filter", &p::Parameter::filter},
      Member{"reach", &p::Parameter::reach},
      Member{"neededIf", &p::Parameter::neededIf},
      Member{"firstPlane", &p::Parameter::firstPlane},
      Member{"planeCount", &p::Parameter::planeCount},
      Member{"layers", &p::Parameter::layers},
      Member{"halo", &p::Parameter::halo},
      Member{"haloShapes", &p::Parameter::haloShapes},
  };
};

template <>
struct Members<p::IntrinsicUse> {
  static constexpr std::tuple list{
      Member{"intrinsic", &p::IntrinsicUse::intrinsic},
      Member{"widths", &p::IntrinsicUse::widths},
      Member{"ofDouble", &p::IntrinsicUse::ofDouble},
  };
};

template <>
struct Members<sk::TableRange> {
  static constexpr std::tuple list{
      Member{"low", &sk::TableRange::low},
      Member{"high", &sk::TableRange::high},
      Member{"intervals", &sk::TableRange::intervals},
  };
};

template <>
struct Members<p::Table> {
  static constexpr std::tuple list{
      Member{"function", &p::Table::function},
      Member{"range", &p::Table::range},
      Member{"interpolation", &p::Table::interpolation},
      Member{"values", &p::Table::values},
  };
};

template <>
struct Members<p::TableUse> {
  static constexpr std::tuple list{
      Member{"table", &p::TableUse::table},
      Member{"name", &p::TableUse::name},
  };
};

template <>
struct Members<p::UnrolledKernel> {
  static constexpr std::tuple list{
      Member{"spec", &p::UnrolledKernel::spec},
      Member{"value", &p::UnrolledKernel::value},
      Member{"kernel", &p::UnrolledKernel::kernel},
  };
};

template <>
struct Members<sk::CallOptions> {
  static constexpr std::tuple list{
      Member{"accumulate", &sk::CallOptions::accumulate},
      Member{"precision", &sk::CallOptions::precision},
      Member{"intrinsics", &sk::CallOptions::intrinsics},
      Member{"tables", &sk::CallOptions::tables},
      Member{"target", &sk::CallOptions::target},
      Member{"contraction", &sk::CallOptions::contraction},
      Member{"order", &sk::CallOptions::order},
      Member{"scan", &sk::CallOptions::scan},
      OmittedMember{&sk::CallOptions::along},  // no declaration chooses it, nor the next
      OmittedMember{&sk::CallOptions::box},
  };
};

template <>
struct Members<p::Kernel> {
  static constexpr std::tuple list{
      Member{"name", &p::Kernel::name},
      Member{"entry", &p::Kernel::entry},
      Member{"declarations", &p::Kernel::declarations},
      Member{"body", &p::Kernel::body},
      Member{"bodyLength", &p::Kernel::bodyLength},
      Member{"parameters", &p::Kernel::parameters},
      OmittedMember{&p::Kernel::sources},  // the file's
      Member{"usesIndex", &p::Kernel::usesIndex},
      Member{"usesExtent", &p::Kernel::usesExtent},
      Member{"usesLoops", &p::Kernel::usesLoops},
      Member{"usesDoubles", &p::Kernel::usesDoubles},
      Member{"usesExactSums", &p::Kernel::usesExactSums},
      Member{"intrinsics", &p::Kernel::intrinsics},
      CountedMember{"plans", &p::Kernel::plans, &p::Kernel::planCount},
      Member{"options", &p::Kernel::options},
      Member{"half", &p::Kernel::half},
      Member{"wide", &p::Kernel::wide},
      Member{"whyNotHalf", &p::Kernel::whyNotHalf},
      Member{"whyNotWide", &p::Kernel::whyNotWide},
      Member{"tables", &p::Kernel::tables},
      Member{"unrolled", &p::Kernel::unrolled},
      Member{"drawn", &p::Kernel::drawn},
      Member{"dispatched", &p::Kernel::dispatched},
      OmittedMember{&p::Kernel::code},  // an address
  };
};

template <>
struct Members<p::PassOperand> {
  static constexpr std::tuple list{
      Member{"isTemporary", &p::PassOperand::isTemporary},
      Member{"index", &p::PassOperand::index},
  };
};

template <>
struct Members<p::Pass> {
  static constexpr std::tuple list{
      Member{"kernel", &p::Pass::kernel},
      Member{"operands", &p::Pass::operands},
  };
};

template <>
struct Members<p::ArgumentPlane> {
  static constexpr std::tuple list{
      Member{"argument", &p::ArgumentPlane::argument},
      Member{"plane", &p::ArgumentPlane::plane},
  };
};

template <>
struct Members<p::Bundle> {
  static constexpr std::tuple list{
      Member{"scalar", &p::Bundle::scalar},
      Member{"width", &p::Bundle::width},
      Member{"layers", &p::Bundle::layers},
  };
};

template <>
struct Members<p::Plan> {
  static constexpr std::tuple list{
      Member{"drawBuffers", &p::Plan::drawBuffers}, Member{"textureUnits", &p::Plan::textureUnits},
      Member{"temporaries", &p::Plan::temporaries}, Member{"bundles", &p::Plan::bundles},
      Member{"passes", &p::Plan::passes},
  };
};

template <>
struct Members<p::SumTerm> {
  static constexpr std::tuple list{
      Member{"factors", &p::SumTerm::factors},
      Member{"kernel", &p::SumTerm::kernel},
  };
};

template <>
struct Members<p::Reduction> {
  static constexpr std::tuple list{
      Member{"fold", &p::Reduction::fold},
      Member{"combine", &p::Reduction::combine},
      Member{"combineOperands", &p::Reduction::combineOperands},
      Member{"addition", &p::Reduction::addition},
      Member{"seeded", &p::Reduction::seeded},
      Member{"compensated", &p::Reduction::compensated},
      Member{"half", &p::Reduction::half},
      Member{"wide", &p::Reduction::wide},
      Member{"exact", &p::Reduction::exact},
      Member{"commutative", &p::Reduction::commutative},
      Member{"term", &p::Reduction::term},
      Member{"parts", &p::Reduction::parts},
  };
};

template <>
struct Members<p::FoldParts> {
  static constexpr std::tuple list{
      OmittedMember{&p::FoldParts::inDoubles},  // for native code
      Member{"map", &p::FoldParts::map},       Member{"mapOperands", &p::FoldParts::mapOperands},
      Member{"after", &p::FoldParts::after},   Member{"afterOperands", &p::FoldParts::afterOperands},
  };
};

template <>
struct Members<p::WideReduction> {
  static constexpr std::tuple list{
      Member{"reduction", &p::WideReduction::reduction},
      Member{"finish", &p::WideReduction::finish},
  };
};

template <>
struct Members<p::CompensatedSum> {
  static constexpr std::tuple list{
      Member{"accumulator", &p::CompensatedSum::accumulator},
      Member{"offset", &p::CompensatedSum::offset},
  };
};

template <>
struct Members<p::CompensatedReduction> {
  static constexpr std::tuple list{
      Member{"reduction", &p::CompensatedReduction::reduction},
      Member{"finish", &p::CompensatedReduction::finish},
      Member{"sums", &p::CompensatedReduction::sums},
      Member{"addsDoubles", &p::CompensatedReduction::addsDoubles},
  };
};

template <>
struct Members<p::ExactSum> {
  static constexpr std::tuple list{
      Member{"reduction", &p::ExactSum::reduction},     Member{"finish", &p::ExactSum::finish},
      Member{"accumulator", &p::ExactSum::accumulator}, Member{"offset", &p::ExactSum::offset},
      Member{"ofProducts", &p::ExactSum::ofProducts},   Member{"term", &p::ExactSum::term},
  };
};

static_assert(listsAll<p::Field> && listsAll<p::Element> && listsAll<p::ConditionStep> &&
                  listsAll<p::Condition> && listsAll<p::Layer> && listsAll<p::Parameter> &&
                  listsAll<p::Distance> && listsAll<p::Reach> && listsAll<p::IntrinsicUse> &&
                  listsAll<sk::TableRange> && listsAll<p::Table> && listsAll<p::TableUse> &&
                  listsAll<p::UnrolledKernel> && listsAll<sk::CallOptions> && listsAll<p::Kernel> &&
                  listsAll<p::PassOperand> && listsAll<p::Pass> && listsAll<p::ArgumentPlane> &&
                  listsAll<p::Bundle> && listsAll<p::Plan> && listsAll<p::SumTerm> &&
                  listsAll<p::Reduction> && listsAll<p::FoldParts> && listsAll<p::WideReduction> &&
                  listsAll<p::CompensatedSum> && listsAll<p::CompensatedReduction> && listsAll<p::ExactSum>,
              "a descriptor has another member: list it, and document it in docs/json.md");

// ---- names of enumerators -------------------------------------------------------------------------

using Names = std::string_view;
// The first enumerator of an option is its default, which is printed as such.
template <>
inline constexpr std::array enumerators<p::Scalar> =
    std::to_array<Names>({"bool", "int", "uint", "float", "double", "half", "char", "uchar", "short",
                          "ushort", "unorm8", "snorm8", "unorm16", "snorm16"});
template <>
inline constexpr std::array enumerators<p::Role> = std::to_array<Names>(
    {"uniform", "input", "output", "gather", "accumulator", "variableOutput", "scatter", "iterator", "spec"});
template <>
inline constexpr std::array enumerators<p::ScatterOp> = std::to_array<Names>({"store", "add", "min", "max"});
template <>
inline constexpr std::array enumerators<p::Boundary> =
    std::to_array<Names>({"clamp", "wrap", "mirror", "border"});
template <>
inline constexpr std::array enumerators<p::Reach::Kind> = std::to_array<Names>({"near", "computed", "whole"});
template <>
inline constexpr std::array enumerators<p::ConditionOp> =
    std::to_array<Names>({"spec", "literal", "not", "and", "or", "bitAnd", "bitOr", "bitXor", "add", "sub",
                          "mul", "less", "lessEqual", "greater", "greaterEqual", "equal", "notEqual"});
template <>
inline constexpr std::array enumerators<p::Intrinsic> = std::to_array<Names>(
    {"sin",  "cos",        "tan",   "asin",  "acos",     "atan",   "atan2",    "sinh",     "cosh",
     "tanh", "asinh",      "acosh", "atanh", "exp",      "exp2",   "log",      "log2",     "log10",
     "pow",  "min",        "max",   "clamp", "saturate", "fract",  "mod",      "fmod",     "mix",
     "step", "smoothstep", "sign",  "isnan", "isinf",    "length", "distance", "normalize"});
template <>
inline constexpr std::array enumerators<sk::Interpolation> = std::to_array<Names>({"linear", "cubic"});
template <>
inline constexpr std::array enumerators<sk::Accumulate> =
    std::to_array<Names>({"default", "tree", "compensated", "extended", "exact"});
template <>
inline constexpr std::array enumerators<sk::Precision> =
    std::to_array<Names>({"default", "half", "single", "extended", "double"});
template <>
inline constexpr std::array enumerators<sk::Intrinsics> =
    std::to_array<Names>({"default", "fast", "accurate"});
template <>
inline constexpr std::array enumerators<sk::Tables> = std::to_array<Names>({"default", "off", "on"});
template <>
inline constexpr std::array enumerators<sk::Target> =
    std::to_array<Names>({"default", "fragment", "compute", "native"});
template <>
inline constexpr std::array enumerators<sk::Contraction> = std::to_array<Names>({"default", "exact", "fast"});
template <>
inline constexpr std::array enumerators<sk::Order> = std::to_array<Names>({"default", "kept", "any"});
template <>
inline constexpr std::array enumerators<sk::Scan> =
    std::to_array<Names>({"default", "inclusive", "exclusive"});

/// Whether `last` is the enumerator that `enumerators` names last.
template <class E>
constexpr bool namesUpTo(E last) {
  return enumerators<E>.size() == static_cast<std::size_t>(last) + 1;
}
static_assert(namesUpTo(p::Scalar::Snorm16) && namesUpTo(p::Role::Spec) && namesUpTo(p::ScatterOp::Max) &&
                  namesUpTo(p::Boundary::Border) && namesUpTo(p::Reach::Kind::Whole) &&
                  namesUpTo(p::ConditionOp::NotEqual) && namesUpTo(p::Intrinsic::Normalize) &&
                  namesUpTo(sk::Interpolation::Cubic) && namesUpTo(sk::Accumulate::Exact) &&
                  namesUpTo(sk::Precision::Double) && namesUpTo(sk::Intrinsics::Accurate) &&
                  namesUpTo(sk::Tables::On) && namesUpTo(sk::Target::Native) &&
                  namesUpTo(sk::Contraction::Fast) && namesUpTo(sk::Order::Any) &&
                  namesUpTo(sk::Scan::Exclusive),
              "an enumeration has another enumerator: name it");

}  // namespace skc::emit
