// SPDX-License-Identifier: MIT
//
// The kernels of adversary.sk: how each is called, which data hurt it, and what it has to compute.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "numbers/case.hpp"
#include "numbers/judge.hpp"
#include "sk/call.hpp"

namespace fuzz::numbers {

enum class Kind : std::uint8_t { Map, Reduce, Scan, Fold };
enum class Role : std::uint8_t { Elements, Table, Uniform };

/// Which numbers a parameter wants.
enum class Data : std::uint8_t { Terms, Arguments, Angles, Fractions, Integers, Trips };

struct Parameter {
  Element element;
  Role role = Role::Elements;
  Data data = Data::Arguments;
};

/// The streams of a call. Those of results follow those of elements, in the order of the declaration.
struct Call {
  sk::CallOptions options;
  std::vector<sk::StreamRegion> inputs;  ///< of uniforms: empty
  std::vector<const Values*> uniforms;  ///< of streams: null
  const sk::RowsState* rows = nullptr;
  std::vector<sk::StreamRegion> outputs;
  std::vector<Values>* values = nullptr;  ///< where a reduce to values writes these
};

/// An element of a map: its components, for one choice of whether denormal numbers are 0.
using Arguments = std::span<const double>;

enum class FoldKind : std::uint8_t {
  FloatSum,
  DoubleSum,
  IntSum,
  Least,
  Most,
  MostInt,
  HashValue,
  HashPower
};

/// What a fold adds to its accumulators. Each component of a vector is an accumulator of its own.
class Terms {
 public:
  Terms(const Arithmetic& device, bool areWide, std::vector<SumJudge>& sums, std::vector<Values>& others)
      : arithmetic(device), isWide(areWide), sums_(sums), others_(others) {}
  void add(std::size_t accumulator, double a, double b = 1) { sums_[accumulator].add(a, b); }
  void addUnknown(std::size_t accumulator) { sums_[accumulator].addUnknown(); }
  /// An element of an accumulator that is no sum of reals.
  void take(std::size_t accumulator, double x) { others_[accumulator].push_back(x); }

  const Arithmetic& arithmetic;
  bool isWide;  ///< what an element computes is not rounded to floats

 private:
  std::vector<SumJudge>& sums_;
  std::vector<Values>& others_;
};

struct Operation {
  std::string_view name;
  Kind kind;
  std::vector<Parameter> inputs;
  std::vector<Element> outputs;  ///< of elements, then of accumulators
  std::vector<FoldKind> folds;  ///< one for each component of an accumulator
  bool startsFromZero;  ///< the fold has an identity
  bool hasDoubles;  ///< among its parameters
  void (*call)(const Call& call);
  /// Maps, and the element outputs of folds: whether component `output` of the outputs may be `got`.
  bool (*accepts)(const MapJudge& judge, Arguments x, std::size_t output, double got);
  /// What element `index` adds. `inputs` are those of the case; `last` is the index in the fastest dimension.
  void (*addTerms)(const std::vector<Values>& inputs, std::size_t index, std::int64_t last, Terms& terms);
  bool isForReals;  ///< takes no integers: may be called in other precisions

  std::size_t componentsOfElementOutputs() const;
};

const std::vector<Operation>& operations();
const Operation& operationNamed(std::string_view name);

std::vector<Operation> mapOperations();
std::vector<Operation> foldOperations();

}  // namespace fuzz::numbers
