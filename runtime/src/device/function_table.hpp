// SPDX-License-Identifier: MIT
//
// Tables of functions (sk/table.hpp), built in double on the host from the function's native code when a
// device first needs them, with their errors. Must not depend on GL.
//
// A bound for the error of a table (sk/table.hpp) over all floats of its range, from samples of the function. Where the error
// of the polynomials bends between two samples, more are taken, down to neighbouring floats if need be; a function that
// still bends is reported as unresolved. Knows neither kernels nor devices.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "device/configuration.hpp"
#include "device/unload_watch.hpp"
#include "sk/native/table.hpp"
#include "sk/program.hpp"
#include "sk/table.hpp"

namespace sk {

/// A function's values, computed in double. Throws if one is not finite.
using FunctionValues = std::function<std::vector<double>(const std::vector<double>& arguments)>;

struct InterpolationError {
  double bound = 0;  ///< of the absolute error of a lookup in float arithmetic
  /// Neighbouring samples between which too many samples would be needed: the bound does not hold.
  std::optional<std::pair<double, double>> unresolved = {};
};

/// The polynomials are those of native::Table. `seen` is an error that occurs.
///
/// Between two samples, the error is at most the larger of the two, and 4 times of what the chord of two samples on either side
/// misses when it is continued across: 8 times of what a kink adds, at least 16 times of what a curve does, and 2.7 times of what the
/// cusp of a square root does. Samples are irregular, so that no period hides between them.
InterpolationError interpolationError(const FunctionValues& values, const TableRange& range,
                                      Interpolation interpolation, std::span<const float> coefficients,
                                      double seen);

struct FunctionTable {
  TableReport report;
  std::vector<float> coefficients;  ///< of each interval, laid out as in assemble/glsl/tables.hpp
  float perUnit;  ///< intervals per unit of the argument
  std::uint64_t number =
      0;  ///< among the tables of its device, those of unloaded libraries included; 0: of none

  native::Table native() const;
};

/// Throws sk::Error if the function has no native code, if a value in the range is not finite, if floats
/// cannot distinguish the range's intervals, or if the function changes too fast for a bound of the error.
FunctionTable buildTable(const program::Table& table, const TableRange& range);

/// The tables of a device.
class FunctionTables {
 public:
  /// Builds the table on first use, over the range that the configuration gives. It is kept until the library with the
  /// function is unloaded.
  const FunctionTable& of(const program::Table& table, const Configuration& configuration);
  std::vector<TableReport> reports() const;
  /// Whether the table with this number is kept.
  bool has(std::uint64_t number) const;

 private:
  struct Kept {
    std::unique_ptr<FunctionTable> table;
    std::uint64_t object = 0;  ///< which loaded object has the descriptor (LinkedFile::objectOf())
  };

  std::map<const program::Table*, Kept> tables_;
  std::uint64_t built_ = 0;
  UnloadWatch unloads_;
};

}  // namespace sk
