// SPDX-License-Identifier: MIT
#include "call/check_rows.hpp"

#include <algorithm>
#include <string_view>

#include "call/check_call.hpp"
#include "device/device_state.hpp"
#include "device/rows_state.hpp"

namespace sk {

using program::Kernel;
using program::Parameter;
using program::Role;

namespace {

const Parameter& firstWith(const Kernel& fold, Role role) {
  return *std::ranges::find(fold.parameters, role, &Parameter::role);
}

void checkDomain(const CallInRows& call, const RowsState& rows) {
  const Kernel& fold = call.reduction.fold;
  const std::string_view input = firstWith(fold, Role::Input).name;
  if (call.domain.rank() != 1) {
    fail(Error::Kind::Shape, fold, "'{}' has shape {}; streams in rows have one dimension", input,
         toString(call.domain));
  }
  for (std::size_t i = 0; i < call.arguments.size(); ++i) {
    const Parameter& parameter = fold.parameters[i];
    const Shape& shape = call.arguments[i].region.shape;
    if (parameter.role != Role::Input || call.arguments[i].rows == nullptr || shape == call.domain) continue;
    fail(Error::Kind::Shape, fold,
         "'{}' has shape {}, but the streams in rows together have {}; give them one shape", parameter.name,
         toString(shape), toString(call.domain));
  }
  const std::int64_t size = call.domain.size();
  if (const std::int64_t row = rows.rowBeyond(size); row >= 0) {
    fail(Error::Kind::Shape, fold, "row {} ends at {}, but '{}' has {} elements; give a stream with all rows",
         row, rows.pieces().starts()[static_cast<std::size_t>(row) + 1], input, size);
  }
  if (call.scan && (rows.begin() != 0 || rows.end() != size)) {
    fail(Error::Kind::Shape, fold,
         "the rows have elements {} to {}, and '{}' has {}; a scan has a result for each element, so give it "
         "a view of those in rows",
         rows.begin(), rows.end(), input, size);
  }
}

void checkIdentities(const CallInRows& call, const RowsState& rows) {
  const Kernel& fold = call.reduction.fold;
  for (const Parameter& parameter : fold.parameters) {
    if (parameter.role != Role::Accumulator || !parameter.identity.empty()) continue;
    if (!call.scan && rows.firstEmptyRow() >= 0) {
      fail(Error::Kind::Shape, fold, "row {} has no element to fold, and '{}' declares no identity",
           rows.firstEmptyRow(), parameter.name);
    }
    if (call.scan && call.scan->isExclusive) {
      fail(fold,
           "an exclusive scan starts with the identity, and '{0}' declares none; write '{0} = ...' in its "
           "declaration, or call it without Scan::Exclusive",
           parameter.name);
    }
  }
}

}  // namespace

const RowsState* rowsOf(const Kernel& fold, std::span<const Argument> arguments,
                        const assemble::SpecValues& specs) {
  const Parameter* first = nullptr;
  const RowsState* rows = nullptr;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const Parameter& parameter = fold.parameters[i];
    if (parameter.role != Role::Input || !assemble::isNeeded(parameter, specs)) continue;
    if (first == nullptr) {
      first = &parameter;
      rows = arguments[i].rows;
    } else if (arguments[i].rows != rows) {
      const bool isOneInRows = rows == nullptr || arguments[i].rows == nullptr;
      fail(fold, "'{}' and '{}' are {}; give all element inputs in the same rows, or none", first->name,
           parameter.name, isOneInRows ? "not both in rows" : "in different rows");
    }
  }
  return rows;
}

Shape checkRows(const CallInRows& call, const RowsState& rows, const Shape& results) {
  const Kernel& fold = call.reduction.fold;
  const std::string_view result = firstWith(fold, Role::Accumulator).name;
  if (rows.device() != &call.device) {
    fail(rows.device() == nullptr ? Error::Kind::Lost : Error::Kind::Device, fold,
         "the rows are {}; make them from a stream of the same device as '{}'",
         rows.device() == nullptr ? "of a device that has ended" : "of another device",
         firstWith(fold, Role::Input).name);
  }
  checkDomain(call, rows);
  if (results.rank() == 0) {
    fail(fold, "each of the {} rows has a result; give a stream of as many elements for '{}'", rows.rows(),
         result);
  }
  const Shape expected = call.scan ? call.domain : Shape{rows.rows()};
  if (results != expected) {
    fail(Error::Kind::Shape, fold, "there are {} {}, but the output '{}' has shape {}; give it shape {}",
         call.scan ? call.domain.size() : rows.rows(), call.scan ? "elements" : "rows", result,
         toString(results), toString(expected));
  }
  if (call.scan && call.scan->along) fail(fold, "rows are scanned each on its own; call it without along");
  checkIdentities(call, rows);
  return expected;
}

void refuseRows(const Kernel& kernel, std::span<const Argument> arguments) {
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    if (arguments[i].rows == nullptr) continue;
    fail(kernel, "'{}' is in rows, which only reduces and scans fold; give the stream itself",
         kernel.parameters[i].name);
  }
}

}  // namespace sk
