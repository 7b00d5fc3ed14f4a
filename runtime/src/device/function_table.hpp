// SPDX-License-Identifier: MIT
//
// Tables of functions (sk/table.hpp): built in double on the host from the native code of the function, each when a
// device first needs it, with the error that it makes. It knows no GL.
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
  std::vector<float> coefficients;  ///< of each interval, as assemble/glsl/tables.hpp has them
  float perUnit;  ///< intervals for each unit of the argument

  native::Table native() const;
};

/// Throws sk::Error where the function has no native code, or a value in the range that is not finite, and where floats
/// cannot tell the intervals of the range.
FunctionTable buildTable(const program::Table& table, const TableRange& range);

/// Those of a device.
class FunctionTables {
 public:
  /// Builds it at first, over the range that the configuration gives.
  const FunctionTable& of(const program::Table& table, const Configuration& configuration);
  std::vector<TableReport> reports() const;

 private:
  std::map<const program::Table*, std::unique_ptr<FunctionTable>> tables_;
};

}  // namespace sk
