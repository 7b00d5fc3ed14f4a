// SPDX-License-Identifier: MIT
//
// Implements the checks of reductions, in the order in which their messages are most helpful.
#include "call/check_reduction.hpp"

#include <algorithm>
#include <string_view>

#include "call/box.hpp"
#include "call/check_call.hpp"
#include "call/resolved_call.hpp"
#include "device/device_state.hpp"
#include "device/region.hpp"
#include "device/rows_state.hpp"
#include "device/stream_state.hpp"
#include "domain/decomposition.hpp"

namespace sk {

namespace {

using program::Kernel;
using program::Parameter;
using program::Reduction;
using program::Role;

/// The streams that a reduction reads or writes.
class Arguments {
 public:
  Arguments(const Reduction& reduction, std::span<const Argument> arguments,
            const std::optional<GivenDomain>& over)
      : reduction_(reduction), fold_(reduction.fold), arguments_(arguments), over_(over) {
    if (arguments.size() != fold_.parameters.size()) {
      fail(fold_, "{} arguments are given, but {} are declared", arguments.size(), fold_.parameters.size());
    }
    specs_ = specsOf(fold_, arguments);
  }

  ResolvedReduction check(std::span<void* const> values, const std::optional<ScanOrder>& scan,
                          const FoldedBox& placed) {
    const bool toStreams = values.empty();
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const Role role = fold_.parameters[i].role;
      const bool isStream = role == Role::Input || role == Role::Gather ||
                            (toStreams && role == Role::Accumulator) ||
                            (role == Role::Uniform && arguments_[i].value == nullptr);
      if (isStream && assemble::isNeeded(fold_.parameters[i], specs_)) {
        checkLives(i);
      }
    }
    const Shape seen = domainOf(fold_, arguments_, specs_, over_);
    checkDomain(fold_, source(), seen);
    DeviceState& device = checkedDevice();
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      checkShape(i, seen);
    }
    const Shape domain = placed.isPlaced() ? domain::shapeOf(placed.box) : seen;
    const RowsState* const rows = rowsOf(fold_, arguments_, specs_);
    ResolvedReduction checked{device, reduction_, arguments_, domain, oneBlock(domain), values};
    checked.placed = placed;
    checkElements(fold_, checked.device, seen, placed.isPlaced());
    checked.device.checkProgram(reduction_);
    checkUniforms(fold_, checked.device);
    checkUnits(checked.device, scan.has_value(), rows != nullptr);
    checked.scan = scan;
    if (rows != nullptr) {
      checked.rows = rows;
      checked.blocks = checkRows({reduction_, arguments_, checked.device, domain, scan}, *rows,
                                 toStreams ? resultShape() : Shape{});
      return checked;
    }
    if (scan) {
      checked.blocks = checkScan(*scan, domain);
      return checked;
    }
    if (toStreams) {
      checked.blocks = checkBlocks(domain, resultShape());
      if (checked.blocks.size() == 0) {
        return checked;
      }
    }
    if (domain.size() == 0) {
      checkIdentities(domain);
    }
    return checked;
  }

 private:
  void checkLives(std::size_t i) {
    const Parameter& parameter = fold_.parameters[i];
    checkGiven(fold_, parameter, arguments_[i]);
    const StreamState& stream = checkStream(fold_, parameter, arguments_[i].region);
    if (first_ == SIZE_MAX) {
      first_ = i;
    }
    checkSameDevice(fold_, fold_.parameters[first_], *arguments_[first_].region.stream, parameter, stream);
  }

  /// The device of the streams or, if there are none, of the given domain.
  DeviceState& checkedDevice() const {
    if (first_ == SIZE_MAX && (!over_ || over_->device == nullptr)) {
      fail(fold_,
           "no stream is given that says what device to fold on; give one, or call it over a shape on a "
           "device, {}.over(device, {{...}})(...)",
           fold_.name);
    }
    DeviceState& device = first_ == SIZE_MAX ? *over_->device : *arguments_[first_].region.stream->device;
    checkGivenDevice(fold_, over_, device);
    return device;
  }

  /// An output defines the domain of a kernel with folded outputs.
  DomainSource source() const { return {firstOutput(fold_, specs_), over_ ? &*over_ : nullptr}; }

  void checkShape(std::size_t i, const Shape& domain) const {
    const Parameter& parameter = fold_.parameters[i];
    if (isValue(parameter, arguments_[i])) {
      checkValue(fold_, parameter, arguments_[i], domain);
    } else if (!assemble::isNeeded(parameter, specs_)) {
      return;
    } else if (parameter.role == Role::Uniform) {
      checkUniformShape(fold_, parameter, arguments_[i].region.shape);
    } else if (parameter.role == Role::Input) {
      checkInputShape(fold_, parameter, arguments_[i], source(), domain);
    } else if (parameter.role == Role::Gather) {
      checkGatherShape(fold_, parameter, arguments_[i].region.shape, domain);
    }
  }

  void checkUnits(const DeviceState& device, bool isScan, bool hasRows) const {
    const std::size_t uniforms = uniformPlanes(fold_, arguments_);
    const auto unitsOf = [&](const Kernel& kernel) {
      return assemble::textureUnits(kernel, specs_, otherUnits(kernel, uniforms, isScan, hasRows));
    };
    const auto most = static_cast<std::size_t>(device.limits.textureUnits);
    if (const std::size_t planes = unitsOf(fold_); planes > most) {
      fail(Error::Kind::Device, fold_,
           "the inputs and gathers{} have {} planes (one a scalar, vector, or member of a struct), but this "
           "device reads {} in one pass; put scalars together in vectors, or divide the {}",
           isScan ? ", and the accumulators of earlier elements," : "", planes, most,
           isScan ? "scan" : "reduce");
    }
    if (const std::size_t planes = unitsOf(reduction_.combine); planes > most) {
      fail(Error::Kind::Device, fold_,
           "to combine partial results, {} planes are read (one a scalar, vector, or member of a struct of "
           "the accumulators), but this device reads {} in one pass; put scalars together in vectors, or "
           "divide the {}",
           planes, most, isScan ? "scan" : "reduce");
    }
  }

  /// Returns the grid of blocks.
  Shape checkScan(const ScanOrder& scan, const Shape& domain) const {
    const Shape results = resultShape();
    if (results != domain) {
      fail(Error::Kind::Shape, fold_,
           "{} {}, and the output '{}' has {}; a scan has one result for each element, so give them the same "
           "shape",
           inputs(), toString(domain), firstResult().name, toString(results));
    }
    if (scan.isExclusive) {
      for (const Parameter& parameter : fold_.parameters) {
        if (parameter.role == Role::Accumulator && parameter.identity.empty()) {
          fail(fold_,
               "an exclusive scan starts with the identity, and '{}' declares none; write '{} = ...' in its "
               "declaration, or call it without Scan::Exclusive",
               parameter.name, parameter.name);
        }
      }
    }
    if (scan.along && (*scan.along < 0 || *scan.along >= domain.rank())) {
      fail(Error::Kind::Shape, fold_, "{} {}, which has no dimension {}; along is 0 to {}", inputs(),
           toString(domain), *scan.along, domain.rank() - 1);
    }
    if (domain.size() == 0) return domain;
    return scan.along ? domain.with(*scan.along, 1) : oneBlock(domain);
  }

  const Parameter& firstResult() const {
    return *std::ranges::find(fold_.parameters, Role::Accumulator, &Parameter::role);
  }

  /// Returns the common shape of the results.
  Shape resultShape() const {
    const Parameter* first = nullptr;
    Shape shape;
    for (std::size_t i = 0; i < arguments_.size(); ++i) {
      const Parameter& result = fold_.parameters[i];
      if (result.role != Role::Accumulator) {
        continue;
      }
      const StreamRegion& region = arguments_[i].region;
      if (first == nullptr) {
        first = &result;
        shape = region.shape;
      } else if (region.shape != shape) {
        fail(Error::Kind::Shape, fold_,
             "the outputs '{}' and '{}' have shapes {} and {}; give them the same shape", first->name,
             result.name, toString(shape), toString(region.shape));
      }
      checkDisjoint(i);
    }
    return shape;
  }

  void checkDisjoint(std::size_t output) const {
    for (std::size_t i = 0; i < output; ++i) {
      if (fold_.parameters[i].role == Role::Accumulator &&
          overlap(arguments_[i].region, arguments_[output].region)) {
        fail(fold_,
             "the outputs '{}' and '{}' overlap: both write elements of one stream; give them different "
             "streams, or regions that have no element in common",
             fold_.parameters[i].name, fold_.parameters[output].name);
      }
    }
  }

  /// Returns the grid of blocks.
  Shape checkBlocks(const Shape& domain, const Shape& shape) const {
    const Parameter& result = firstResult();
    const std::vector<Shape> grids = blockGrids(domain, shape);
    if (grids.size() == 1) {
      return grids.front();
    }
    if (grids.empty()) {
      fail(Error::Kind::Shape, fold_,
           "{} {}, and the output '{}' has {}; give the output as many dimensions, or fewer, each extent a "
           "divisor of the input's",
           inputs(), toString(domain), result.name, toString(shape));
    }
    fail(Error::Kind::Shape, fold_,
         "{} {}, and the output '{}' has {}, which could mean {} or {}; write the one that you mean",
         inputs(), toString(domain), result.name, toString(shape), toString(grids[0]), toString(grids[1]));
  }

  /// "'x' has shape" for one input, "the inputs together have" for several.
  std::string inputs() const {
    if (const Parameter* const output = source().output) return fmt::format("'{}' has shape", output->name);
    if (over_) return "over() gives the domain the shape";
    const auto isInput = [](const Parameter& parameter) { return parameter.role == Role::Input; };
    const auto count = std::ranges::count_if(fold_.parameters, isInput);
    if (count == 0) return "the iterators give the domain the shape";
    if (count > 1) return "the inputs together have shape";
    return fmt::format("'{}' has shape", std::ranges::find_if(fold_.parameters, isInput)->name);
  }

  void checkIdentities(const Shape& domain) const {
    for (const Parameter& parameter : fold_.parameters) {
      if (parameter.role == Role::Accumulator && parameter.identity.empty()) {
        fail(Error::Kind::Shape, fold_, "{} {}: there is no element to fold, and '{}' declares no identity",
             inputs(), toString(domain), parameter.name);
      }
    }
  }

  const Reduction& reduction_;
  const Kernel& fold_;
  std::span<const Argument> arguments_;
  const std::optional<GivenDomain>& over_;
  assemble::SpecValues specs_{};
  std::size_t first_ = SIZE_MAX;  ///< the argument that determines the device
};

}  // namespace

assemble::OtherUnits otherUnits(const Kernel& kernel, std::size_t uniforms, bool isScan, bool hasRows) {
  return {.uniforms = uniforms,
          .carried = isScan ? assemble::accumulatorPlanes(kernel) : 0,
          .rows = hasRows ? rowTables : 0};
}

ResolvedReduction checkReduction(const Reduction& reduction, std::span<const Argument> arguments,
                                 std::span<void* const> values, const std::optional<ScanOrder>& scan,
                                 const FoldedBox& placed, const std::optional<GivenDomain>& over) {
  return Arguments(reduction, arguments, over).check(values, scan, placed);
}

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
