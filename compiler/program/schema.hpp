// SPDX-License-Identifier: MIT
//
// The schema of descriptors: all members of each struct of sk/program.hpp, and all enumerators, by name. What prints descriptors,
// as C++ constants (constants.cpp) or as JSON (json.cpp), follows it. A descriptor with a member that is missing here does not compile.
//
// Counts the members of a descriptor at compile time, so that what prints descriptors can assert that it knows all of
// them. All that C++20 tells of the members of an aggregate is their number.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include "program/constants.hpp"
#include "sk/program.hpp"

namespace skc::emit {

/// Stands for any member; only its type is used.
struct AnyMember {
  template <class T>
  operator T() const;
};

template <class T, std::size_t... I>
constexpr bool takes(std::index_sequence<I...>) {
  return requires { T{(static_cast<void>(I), AnyMember{})...}; };
}

/// The number of members of an aggregate without arrays and base classes.
template <class T, std::size_t Count = 0>
constexpr std::size_t memberCount() {
  if constexpr (takes<T>(std::make_index_sequence<Count + 1>{})) {
    return memberCount<T, Count + 1>();
  } else {
    return Count;
  }
}

/// A member, in order of declaration. `part` names the constants that it refers to.
template <class T, class M>
struct Member {
  std::string_view name;
  M T::* pointer;
  std::optional<Part> part = {};
  static constexpr std::size_t count = 1;
};

/// The same with a default, at which C++ leaves it out.
template <class T, class M>
struct Option {
  std::string_view name;
  M T::* pointer;
  std::optional<Part> part = {};
  static constexpr std::size_t count = 1;
};

/// An array that a descriptor has as two members with defaults, a pointer and a number.
template <class T, class M, class N>
struct CountedOption {
  std::string_view name;
  const M* T::* first;
  std::string_view numberName;
  N T::* number;
  std::optional<Part> part = {};
  static constexpr std::size_t count = 2;
};

/// A member that is no data, because it only has a meaning in C++ or is the same in all descriptors of a file.
template <class T, class M>
struct CppOption {
  std::string_view name;
  M T::* pointer;
  std::optional<Part> part = {};
  static constexpr std::size_t count = 1;
};

/// A member that no declaration sets.
template <class T, class M>
struct OmittedMember {
  M T::* pointer;
  static constexpr std::size_t count = 1;
};

/// `Members<T>::type` is the name of T in namespace sk::program, `Members<T>::list` a tuple of its members.
template <class T>
struct Members;

template <class T>
concept Described = requires { Members<T>::list; };

template <class T>
constexpr bool listsAll = std::apply([](const auto&... member) { return (member.count + ...); },
                                     Members<T>::list) == memberCount<T>();

/// An enumeration's name in namespace sk::program, and the names of its enumerators in data, in order. In C++ they begin with
/// a capital letter.
template <std::size_t Count>
struct Enumeration {
  std::string_view type;
  std::array<std::string_view, Count> names;
};
template <class E>
constexpr Enumeration<0> enumeration;

/// The name of an enumerator in data: "bitAnd".
template <class E>
std::string_view nameOf(E enumerator) {
  return enumeration<E>.names[static_cast<std::size_t>(enumerator)];
}

namespace p = sk::program;

template <>
struct Members<p::Field> {
  static constexpr std::string_view type = "Field";
  static constexpr std::tuple list{
      Member{"path", &p::Field::path},   Member{"scalar", &p::Field::scalar},
      Member{"width", &p::Field::width}, Member{"offset", &p::Field::offset},
      Option{"part", &p::Field::part},
  };
};

template <>
struct Members<p::Element> {
  static constexpr std::string_view type = "Element";
  static constexpr std::tuple list{
      Member{"name", &p::Element::name},
      Member{"glsl", &p::Element::glsl},
      Member{"size", &p::Element::size},
      Member{"fields", &p::Element::fields, Part::Fields},
  };
};

template <>
struct Members<p::ConditionStep> {
  static constexpr std::string_view type = "ConditionStep";
  static constexpr std::tuple list{
      Member{"op", &p::ConditionStep::op},
      Member{"scalar", &p::ConditionStep::scalar},
      Option{"value", &p::ConditionStep::value},
  };
};

template <>
struct Members<p::Condition> {
  static constexpr std::string_view type = "Condition";
  static constexpr std::tuple list{
      Option{"steps", &p::Condition::steps, Part::Needs},
      Option{"text", &p::Condition::text},
  };
};

template <>
struct Members<p::Layer> {
  static constexpr std::string_view type = "Layer";
  static constexpr std::tuple list{
      Member{"stack", &p::Layer::stack},
      Member{"layer", &p::Layer::layer},
      Member{"count", &p::Layer::count},
  };
};

template <>
struct Members<p::Distance> {
  static constexpr std::string_view type = "Distance";
  static constexpr std::tuple list{
      Member{"constant", &p::Distance::constant},
      Option{"perSpec", &p::Distance::perSpec},
  };
};

template <>
struct Members<p::Reach> {
  static constexpr std::string_view type = "Reach";
  static constexpr std::tuple list{
      Member{"dimension", &p::Reach::dimension},   Member{"kind", &p::Reach::kind},
      Option{"below", &p::Reach::below},           Option{"above", &p::Reach::above},
      Option{"isPromised", &p::Reach::isPromised},
  };
};

template <>
struct Members<p::Parameter> {
  static constexpr std::string_view type = "Parameter";
  static constexpr std::tuple list{
      Member{"name", &p::Parameter::name},
      Member{"symbol", &p::Parameter::symbol},
      Member{"role", &p::Parameter::role},
      Member{"element", &p::Parameter::element},
      Option{"held", &p::Parameter::held},
      Option{"rank", &p::Parameter::rank},
      Option{"boundary", &p::Parameter::boundary},
      Option{"border", &p::Parameter::border},
      Option{"identity", &p::Parameter::identity},
      Option{"scatter", &p::Parameter::scatter},
      Option{"pushes", &p::Parameter::pushes},
      Option{"usesIndex", &p::Parameter::usesIndex},
      Option{"usesExtent", &p::Parameter::usesExtent},
      Option{"usesAt", &p::Parameter::usesAt},
      Option{"usesNear", &p::Parameter::usesNear},
      Option{"usesSample", &p::Parameter::usesSample},
      Option{"filter", &p::Parameter::filter},
      Option{"reach", &p::Parameter::reach},
      Option{"neededIf", &p::Parameter::neededIf},
      Option{"firstPlane", &p::Parameter::firstPlane},
      Option{"planeCount", &p::Parameter::planeCount},
      Option{"layers", &p::Parameter::layers, Part::Layers},
      Option{"halo", &p::Parameter::halo, Part::Halo},
      Option{"haloShapes", &p::Parameter::haloShapes},
      Option{"range", &p::Parameter::range},
  };
};

template <>
struct Members<p::ValueRange> {
  static constexpr std::string_view type = "ValueRange";
  static constexpr std::tuple list{
      Member{"low", &p::ValueRange::low},
      Member{"high", &p::ValueRange::high},
  };
};

template <>
struct Members<p::IntrinsicUse> {
  static constexpr std::string_view type = "IntrinsicUse";
  static constexpr std::tuple list{
      Member{"intrinsic", &p::IntrinsicUse::intrinsic},
      Member{"widths", &p::IntrinsicUse::widths},
      Option{"ofDouble", &p::IntrinsicUse::ofDouble},
  };
};

template <>
struct Members<sk::TableRange> {
  static constexpr std::string_view type = "TableRange";
  static constexpr std::tuple list{
      Member{"low", &sk::TableRange::low},
      Member{"high", &sk::TableRange::high},
      Member{"intervals", &sk::TableRange::intervals},
  };
};

template <>
struct Members<p::Table> {
  static constexpr std::string_view type = "Table";
  static constexpr std::tuple list{
      Member{"function", &p::Table::function},
      Member{"range", &p::Table::range},
      Member{"interpolation", &p::Table::interpolation},
      Member{"values", &p::Table::values},
  };
};

template <>
struct Members<p::TableUse> {
  static constexpr std::string_view type = "TableUse";
  static constexpr std::tuple list{
      Member{"table", &p::TableUse::table},
      Member{"name", &p::TableUse::name},
  };
};

template <>
struct Members<p::UnrolledKernel> {
  static constexpr std::string_view type = "UnrolledKernel";
  static constexpr std::tuple list{
      Member{"spec", &p::UnrolledKernel::spec},
      Member{"value", &p::UnrolledKernel::value},
      Member{"kernel", &p::UnrolledKernel::kernel},
  };
};

template <>
struct Members<sk::CallOptions> {
  static constexpr std::string_view type = "CallOptions";
  static constexpr std::tuple list{
      Option{"accumulate", &sk::CallOptions::accumulate},
      Option{"precision", &sk::CallOptions::precision},
      Option{"intrinsics", &sk::CallOptions::intrinsics},
      Option{"tables", &sk::CallOptions::tables},
      Option{"target", &sk::CallOptions::target},
      Option{"contraction", &sk::CallOptions::contraction},
      Option{"order", &sk::CallOptions::order},
      Option{"scan", &sk::CallOptions::scan},
      OmittedMember{&sk::CallOptions::along},
      OmittedMember{&sk::CallOptions::box},
      OmittedMember{&sk::CallOptions::over},
  };
};

template <>
struct Members<p::Definition> {
  static constexpr std::string_view type = "Definition";
  static constexpr std::tuple list{
      Option{"name", &p::Definition::name},
      Option{"bytes", &p::Definition::bytes},
  };
};

template <>
struct Members<p::Kernel> {
  static constexpr std::string_view type = "Kernel";
  static constexpr std::tuple list{
      Member{"name", &p::Kernel::name},
      Member{"entry", &p::Kernel::entry},
      Member{"declarations", &p::Kernel::declarations, Part::Declarations},
      Member{"body", &p::Kernel::body, Part::Body},
      Member{"weight", &p::Kernel::weight},
      Member{"parameters", &p::Kernel::parameters, Part::Parameters},
      CppOption{"sources", &p::Kernel::sources},  // the file's
      Option{"usesIndex", &p::Kernel::usesIndex},
      Option{"usesExtent", &p::Kernel::usesExtent},
      Option{"usesLoops", &p::Kernel::usesLoops},
      Option{"usesDoubles", &p::Kernel::usesDoubles},
      Option{"usesLongs", &p::Kernel::usesLongs},
      Option{"usesExactSums", &p::Kernel::usesExactSums},
      Option{"intrinsics", &p::Kernel::intrinsics, Part::Intrinsics},
      CppOption{"definitions", &p::Kernel::definitions,
                Part::Definitions},  // only native programs fuse calls
      CountedOption{"plans", &p::Kernel::plans, "planCount", &p::Kernel::planCount, Part::Plans},
      Option{"options", &p::Kernel::options},
      Option{"half", &p::Kernel::half, Part::Half},
      Option{"wide", &p::Kernel::wide, Part::Wide},
      Option{"whyNotHalf", &p::Kernel::whyNotHalf},
      Option{"whyNotWide", &p::Kernel::whyNotWide},
      Option{"tables", &p::Kernel::tables, Part::Tables},
      Option{"unrolled", &p::Kernel::unrolled, Part::Unrolled},
      Option{"drawn", &p::Kernel::drawn},
      Option{"dispatched", &p::Kernel::dispatched},
      CppOption{"code", &p::Kernel::code},  // an address
      Option{"assertions", &p::Kernel::assertions, Part::Assertions},
  };
};

template <>
struct Members<p::Assertion> {
  static constexpr std::string_view type = "Assertion";
  static constexpr std::tuple list{
      Member{"file", &p::Assertion::file},
      Member{"line", &p::Assertion::line},
      Member{"text", &p::Assertion::text},
  };
};

template <>
struct Members<p::AssertionCheck> {
  static constexpr std::string_view type = "AssertionCheck";
  static constexpr std::tuple list{
      Member{"check", &p::AssertionCheck::check, Part::Check},
      Member{"operands", &p::AssertionCheck::operands, Part::Operands},
      Member{"assertions", &p::AssertionCheck::assertions, Part::Conditions},
  };
};

template <>
struct Members<p::PassOperand> {
  static constexpr std::string_view type = "PassOperand";
  static constexpr std::tuple list{
      Member{"isTemporary", &p::PassOperand::isTemporary},
      Member{"index", &p::PassOperand::index},
  };
};

template <>
struct Members<p::Pass> {
  static constexpr std::string_view type = "Pass";
  static constexpr std::tuple list{
      Member{"kernel", &p::Pass::kernel},
      Member{"operands", &p::Pass::operands, Part::Operands},
  };
};

template <>
struct Members<p::ArgumentPlane> {
  static constexpr std::string_view type = "ArgumentPlane";
  static constexpr std::tuple list{
      Member{"argument", &p::ArgumentPlane::argument},
      Member{"plane", &p::ArgumentPlane::plane},
  };
};

template <>
struct Members<p::Stack> {
  static constexpr std::string_view type = "Stack";
  static constexpr std::tuple list{
      Member{"scalar", &p::Stack::scalar},
      Member{"width", &p::Stack::width},
      Member{"layers", &p::Stack::layers, Part::Layers},
  };
};

template <>
struct Members<p::Plan> {
  static constexpr std::string_view type = "Plan";
  static constexpr std::tuple list{
      Member{"drawBuffers", &p::Plan::drawBuffers},
      Member{"textureUnits", &p::Plan::textureUnits},
      Member{"temporaries", &p::Plan::temporaries, Part::Temporaries},
      Member{"stacks", &p::Plan::stacks, Part::Stacks},
      Member{"passes", &p::Plan::passes, Part::Passes},
  };
};

template <>
struct Members<p::SumTerm> {
  static constexpr std::string_view type = "SumTerm";
  static constexpr std::tuple list{
      Option{"factors", &p::SumTerm::factors, Part::Factors},
      Option{"kernel", &p::SumTerm::kernel},
  };
};

template <>
struct Members<p::Reduction> {
  static constexpr std::string_view type = "Reduction";
  static constexpr std::tuple list{
      Member{"fold", &p::Reduction::fold},
      Member{"combine", &p::Reduction::combine, Part::Combine},
      Member{"combineOperands", &p::Reduction::combineOperands, Part::Operands},
      Option{"addition", &p::Reduction::addition, Part::Addition},
      Member{"seeded", &p::Reduction::seeded},
      Option{"compensated", &p::Reduction::compensated, Part::Compensated},
      Option{"half", &p::Reduction::half, Part::Half},
      Option{"wide", &p::Reduction::wide, Part::Wide},
      Option{"exact", &p::Reduction::exact, Part::Exact},
      Option{"commutative", &p::Reduction::commutative},
      Option{"term", &p::Reduction::term, Part::Term},
      Option{"parts", &p::Reduction::parts, Part::Parts},
  };
};

template <>
struct Members<p::FoldParts> {
  static constexpr std::string_view type = "FoldParts";
  static constexpr std::tuple list{
      CppOption{"inDoubles", &p::FoldParts::inDoubles, Part::InDoubles},  // for native code
      Member{"map", &p::FoldParts::map, Part::Map},
      Member{"mapOperands", &p::FoldParts::mapOperands, Part::Operands},
      Option{"after", &p::FoldParts::after, Part::After},
      Option{"afterOperands", &p::FoldParts::afterOperands, Part::From},
  };
};

template <>
struct Members<p::WideReduction> {
  static constexpr std::string_view type = "WideReduction";
  static constexpr std::tuple list{
      Member{"reduction", &p::WideReduction::reduction},
      Member{"finish", &p::WideReduction::finish, Part::Finish},
  };
};

template <>
struct Members<p::CompensatedSum> {
  static constexpr std::string_view type = "CompensatedSum";
  static constexpr std::tuple list{
      Member{"accumulator", &p::CompensatedSum::accumulator},
      Member{"offset", &p::CompensatedSum::offset},
  };
};

template <>
struct Members<p::CompensatedReduction> {
  static constexpr std::string_view type = "CompensatedReduction";
  static constexpr std::tuple list{
      Member{"reduction", &p::CompensatedReduction::reduction},
      Member{"finish", &p::CompensatedReduction::finish, Part::Finish},
      Member{"sums", &p::CompensatedReduction::sums, Part::Sums},
      Option{"addsDoubles", &p::CompensatedReduction::addsDoubles},
  };
};

template <>
struct Members<p::ExactSum> {
  static constexpr std::string_view type = "ExactSum";
  static constexpr std::tuple list{
      Member{"reduction", &p::ExactSum::reduction},     Member{"finish", &p::ExactSum::finish, Part::Finish},
      Member{"accumulator", &p::ExactSum::accumulator}, Option{"offset", &p::ExactSum::offset},
      Option{"ofProducts", &p::ExactSum::ofProducts},   Option{"term", &p::ExactSum::term, Part::Term},
  };
};

static_assert(listsAll<p::Field> && listsAll<p::Element> && listsAll<p::ConditionStep> &&
                  listsAll<p::Condition> && listsAll<p::Layer> && listsAll<p::Parameter> &&
                  listsAll<p::Distance> && listsAll<p::Reach> && listsAll<p::ValueRange> &&
                  listsAll<p::IntrinsicUse> && listsAll<sk::TableRange> && listsAll<p::Table> &&
                  listsAll<p::TableUse> && listsAll<p::UnrolledKernel> && listsAll<sk::CallOptions> &&
                  listsAll<p::Kernel> && listsAll<p::Assertion> && listsAll<p::AssertionCheck> &&
                  listsAll<p::PassOperand> && listsAll<p::Pass> && listsAll<p::ArgumentPlane> &&
                  listsAll<p::Stack> && listsAll<p::Plan> && listsAll<p::SumTerm> && listsAll<p::Reduction> &&
                  listsAll<p::FoldParts> && listsAll<p::WideReduction> && listsAll<p::CompensatedSum> &&
                  listsAll<p::CompensatedReduction> && listsAll<p::ExactSum>,
              "a descriptor has another member: list it, and document it in docs/json.md");

// ---- names of enumerators -------------------------------------------------------------------------

// The first enumerator of an option is its default, which is printed as such.
template <>
inline constexpr Enumeration<16> enumeration<p::Scalar> = {
    "Scalar",
    {"bool", "int", "uint", "float", "double", "long", "ulong", "half", "char", "uchar", "short", "ushort",
     "unorm8", "snorm8", "unorm16", "snorm16"}};
template <>
inline constexpr Enumeration<9> enumeration<p::Role> = {
    "Role",
    {"uniform", "input", "output", "gather", "accumulator", "variableOutput", "scatter", "iterator", "spec"}};
template <>
inline constexpr Enumeration<4> enumeration<p::ScatterOp> = {"ScatterOp", {"store", "add", "min", "max"}};
template <>
inline constexpr Enumeration<4> enumeration<p::Boundary> = {"Boundary",
                                                            {"clamp", "wrap", "mirror", "border"}};
template <>
inline constexpr Enumeration<3> enumeration<p::Reach::Kind> = {"Reach::Kind", {"near", "computed", "whole"}};
template <>
inline constexpr Enumeration<17> enumeration<p::ConditionOp> = {
    "ConditionOp",
    {"spec", "literal", "not", "and", "or", "bitAnd", "bitOr", "bitXor", "add", "sub", "mul", "less",
     "lessEqual", "greater", "greaterEqual", "equal", "notEqual"}};
template <>
inline constexpr Enumeration<41> enumeration<p::Intrinsic> = {
    "Intrinsic",
    {"sin",   "cos",      "tan",    "asin",     "acos",     "atan", "atan2", "sinh",       "cosh",
     "tanh",  "asinh",    "acosh",  "atanh",    "exp",      "exp2", "log",   "log2",       "log10",
     "hypot", "log1p",    "expm1",  "cbrt",     "erf",      "erfc", "pow",   "min",        "max",
     "clamp", "saturate", "fract",  "mod",      "fmod",     "mix",  "step",  "smoothstep", "sign",
     "isnan", "isinf",    "length", "distance", "normalize"}};
template <>
inline constexpr Enumeration<2> enumeration<sk::Interpolation> = {"Interpolation", {"linear", "cubic"}};
template <>
inline constexpr Enumeration<5> enumeration<sk::Accumulate> = {
    "Accumulate", {"default", "tree", "compensated", "extended", "exact"}};
template <>
inline constexpr Enumeration<5> enumeration<sk::Precision> = {
    "Precision", {"default", "half", "single", "extended", "double"}};
template <>
inline constexpr Enumeration<3> enumeration<sk::Intrinsics> = {"Intrinsics", {"default", "fast", "accurate"}};
template <>
inline constexpr Enumeration<3> enumeration<sk::Tables> = {"Tables", {"default", "off", "on"}};
template <>
inline constexpr Enumeration<4> enumeration<sk::Target> = {"Target",
                                                           {"default", "fragment", "compute", "native"}};
template <>
inline constexpr Enumeration<3> enumeration<sk::Contraction> = {"Contraction", {"default", "exact", "fast"}};
template <>
inline constexpr Enumeration<3> enumeration<sk::Order> = {"Order", {"default", "kept", "any"}};
template <>
inline constexpr Enumeration<3> enumeration<sk::Scan> = {"Scan", {"default", "inclusive", "exclusive"}};

/// Whether `last` is the enumerator that `enumeration` names last.
template <class E>
constexpr bool namesUpTo(E last) {
  return enumeration<E>.names.size() == static_cast<std::size_t>(last) + 1;
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
