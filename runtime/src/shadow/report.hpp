// SPDX-License-Identifier: MIT
//
// What a shadow has found out about a program (docs/accuracy.md, docs/json.md). Errors are relative to the root mean square of
// the reference's components, unless said otherwise.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "shadow/options.hpp"
#include "shadow/shares.hpp"

namespace sk::shadow {

/// A parameter's value at an element.
struct Input {
  std::string parameter;
  double value;
  bool isReal = true;
  std::vector<std::int64_t> at = {};  ///< of a gather: the element's index in it, rows first
};

/// An element of an output, and what it was computed from.
struct ElementRecord {
  std::int64_t call = 0;  ///< number of the call, from 1
  std::string output;
  std::vector<std::int64_t> index;  ///< in the stream, rows first
  double device = 0, reference = 0;  ///< the reference computes with the device's inputs
  bool isReal = true;
  std::vector<Input> inputs;
  std::string source;  ///< what it was computed from, if that is more or less than the inputs say
};

/// The largest of several errors, and their geometric mean.
class Spread {
 public:
  void add(double error) {
    largest_ = std::fmax(largest_, error);
    ++count_;
    if (error > 0 && std::isfinite(error)) {
      logarithms_ += std::log(error);
      ++positive_;
    }
  }
  bool isEmpty() const { return count_ == 0; }
  double largest() const { return largest_; }
  /// The geometric mean of the errors above 0.
  double typical() const {
    return positive_ == 0 ? 0 : std::exp(logarithms_ / static_cast<double>(positive_));
  }
  std::int64_t count() const { return count_; }
  std::int64_t positive() const { return positive_; }
  double sumOfLogarithms() const { return logarithms_; }
  void add(const Spread& other) {
    largest_ = std::fmax(largest_, other.largest_);
    logarithms_ += other.logarithms_;
    positive_ += other.positive_;
    count_ += other.count_;
  }

 private:
  double largest_ = 0, logarithms_ = 0;
  std::int64_t positive_ = 0, count_ = 0;
};

/// Errors over the calls of a program, thinned out so that a program may run for long: each point stands for the largest errors
/// of consecutive calls.
class Series {
 public:
  struct Point {
    std::int64_t call;
    double own, inherited, total;
    double absolute = 0;  ///< the root mean square of the total error
    bool isTurned = false;  ///< the call has mostly changed the signs of what it read
  };
  void add(const Point& point);
  /// Takes the larger errors of both, point by point.
  void raise(const Series& other);
  const std::vector<Point>& points() const { return points_; }
  template <class Archive>
  void visitMembers(Archive& archive) {
    archive(points_, step_, inLast_);
  }

 private:
  std::vector<Point> points_;
  std::int64_t step_ = 1;  ///< values for each point
  std::int64_t inLast_ = 0;  ///< values in the last point
};

struct OutputRecord {
  std::string name, type;
  Series points;
  std::int64_t unreadCalls = 0;  ///< whose elements nothing read before they were overwritten or destroyed
  double unreadSeconds = 0;
};

struct KernelRecord {
  std::string name;
  std::int64_t calls = 0, followed = 0;
  double seconds = 0;
  Spread own, storage, inherited, total, amplification;
  double share = 0;  ///< of the errors of the results
  std::optional<ElementRecord> worst;
  double worstError = 0;  ///< relative to the scale of its output
  std::int64_t nans = 0, infinities = 0, flushed = 0, decisions = 0;
  double ownSquares = 0, storedSquares = 0;  ///< sums over calls: of own errors, and of storing in them
  std::string stored,
      storedBetter;  ///< "'v' in halves", "floats"; empty if its outputs hold what it computes
  std::vector<int> readFrom;  ///< kernels whose outputs it has read
  bool compensates = false;  ///< its own errors have made those of others smaller
  std::string choices;  ///< the options of its calls that are not the default: "precision half"

  /// Whether most of its own errors is rounding on storing.
  bool isStored() const { return storedSquares > 0.5 * ownSquares; }
  std::vector<OutputRecord> outputs;
};

struct StreamRecord {
  std::string name, type;
  std::vector<std::int64_t> shape;
  std::int64_t resyncs = 0;  ///< times that the reference took the device's elements over
  Series points;
  double unread = 0;  ///< elements written and never read, of
  double written = 0;  ///< all elements written
  double unreadSeconds = 0;
};

/// What the host read.
struct ResultRecord {
  std::string name;
  bool isValue = false;  ///< of a reduce
  std::int64_t reads = 0, elements = 0;
  double largest = 0, last = 0;  ///< relative errors of the reads
  double scale = 0;  ///< of a value: the largest of the reads, since a sum may be 0 by chance
  std::int64_t differs = 0;  ///< integers that differ
  std::int64_t numbers = 0;  ///< real components of the last read; 0 if it has none
  std::int64_t withoutValue =
      0;  ///< numbers of a read that are NaN or infinite, whatever the reference has; the most of all reads
  int exception = -1;  ///< number of the record of what they come from
  std::int64_t notFinite = 0;  ///< elements of the last read that are not finite, where the reference's are
  Shares shares;  ///< of the read with the largest error
};

/// What the host gives a parameter of a kernel: a value, or a stream that it has written.
struct GivenRecord {
  int kernel = 0;
  std::string parameter, type;
  std::string scalar;  ///< of its numbers: "float", "half", "int" ...
  bool isStream = false;
  std::string stream;  ///< its name, if it has one
  double low = std::numeric_limits<double>::infinity(),
         high = -std::numeric_limits<double>::infinity();  ///< of its numbers
  bool hasRange = false;
  double rangeLow = 0, rangeHigh = 0;  ///< what [[range]] declares, of all parameters that get the stream
  std::int64_t elements = 0, times = 0;
};

/// Loops that end by one condition.
struct LoopRecord {
  std::string condition;
  std::int64_t runs = 0;
  std::int64_t unfinished = 0;  ///< runs that their limit ended, not the condition
  std::int64_t longest = 0;  ///< iterations
};

struct Path {
  std::int64_t call;
  int kernel;
  std::string output;
  std::int64_t elements;
};

struct ExceptionRecord {
  enum class Kind : std::uint8_t { Nan, Infinity, Flush } kind;
  int kernel;
  std::int64_t elements;
  bool isInReference;  ///< the reference computes it from the same inputs, too
  ElementRecord first;
  std::vector<Path> path;  ///< where it went
};

struct DecisionRecord {
  int kernel;
  std::int64_t elements;
  bool isInherited;
  ElementRecord first;
  std::optional<double> ofKeys = {};  ///< of an order: the relative error of the keys
};

struct Verdict {
  std::string kind, kernel, text;
  std::int64_t call = 0;
};

struct Report {
  std::string program, device, reference = "double";
  std::string ended;  ///< "normally", or "early: ..."
  Options options;
  double programSeconds = 0, deviceSeconds = 0, referenceSeconds = 0, comparisonSeconds = 0;
  std::int64_t calls = 0, followed = 0;
  int ranks = 1, rank = 0;
  std::vector<KernelRecord> kernels;
  std::vector<StreamRecord> streams;
  std::vector<ResultRecord> results;
  std::vector<ExceptionRecord> exceptions;
  std::vector<DecisionRecord> decisions;
  std::vector<GivenRecord> given;
  std::vector<LoopRecord> loops;
  std::vector<std::string> notes;
  std::vector<Verdict> verdicts;

  std::string_view nameOf(int kernel) const;
};

/// Computes what follows from the rest: each kernel's share of the results' errors, and the verdicts, the gravest first.
void conclude(Report& report);

/// Patterns of the options kernels= and quad= that match no kernel of a program that has ended: a sentence for each.
std::vector<std::string> unmatchedPatterns(const Report& report);

/// The report as JSON (docs/json.md).
std::string toJson(const Report& report);

}  // namespace sk::shadow
