// SPDX-License-Identifier: MIT
//
// Tables of functions (sk/table.hpp), built in double on the host from the function's native code when a
// device first needs them, with their errors. Must not depend on GL.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "device/configuration.hpp"
#include "sk/native/table.hpp"
#include "sk/program.hpp"
#include "sk/table.hpp"

namespace sk {

struct FunctionTable {
  TableReport report;
  std::vector<float> coefficients;  ///< of each interval, laid out as in assemble/glsl/tables.hpp
  float perUnit;  ///< intervals per unit of the argument

  native::Table native() const;
};

/// Throws sk::Error if the function has no native code, if a value in the range is not finite, if floats
/// cannot distinguish the range's intervals, or if the function changes too fast for a bound of the error.
FunctionTable buildTable(const program::Table& table, const TableRange& range);

/// The tables of a device.
class FunctionTables {
 public:
  /// Builds the table on first use, over the range that the configuration gives.
  const FunctionTable& of(const program::Table& table, const Configuration& configuration);
  std::vector<TableReport> reports() const;

 private:
  std::map<const program::Table*, std::unique_ptr<FunctionTable>> tables_;
};

}  // namespace sk
