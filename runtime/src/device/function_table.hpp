// SPDX-License-Identifier: MIT
//
// Tables of functions (sk/table.hpp), built in double on the host from the function's native code when a
// device first needs them, with their errors. Must not depend on GL.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "device/configuration.hpp"
#include "device/unload_watch.hpp"
#include "sk/native/table.hpp"
#include "sk/program.hpp"
#include "sk/table.hpp"

namespace sk {

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
