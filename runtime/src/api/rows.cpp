// SPDX-License-Identifier: MIT
//
// sk::Rows: reads and checks the starts of rows.
#include "sk/rows.hpp"

#include <vector>

#include <fmt/format.h>

#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/rows_state.hpp"
#include "device/stream_state.hpp"
#include "results/call_scope.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"

namespace sk {

namespace {

void checkStarts(const std::vector<std::int32_t>& starts) {
  if (starts.front() < 0) {
    throw Error(fmt::format("rows: row 0 starts at {}; starts are 0 or more", starts.front()));
  }
  for (std::size_t row = 0; row + 1 < starts.size(); ++row) {
    if (starts[row + 1] >= starts[row]) continue;
    throw Error(fmt::format("rows: row {} starts at {}, but ends at {}; starts must not decrease", row,
                            starts[row], starts[row + 1]));
  }
}

}  // namespace

void detail::RowsDeleter::operator()(RowsState* state) const noexcept { state->leave(); }

detail::RowsOwner detail::makeRows(const StreamRegion& region) {
  return withHostMemory("rows", [&] {
    const StreamState& stream = liveStream(region, "rows");
    const results::InternalWork reading(*stream.device);
    refuseInRecording(*stream.device, "rows");
    if (region.shape.rank() != 1 || region.shape.size() == 0) {
      throw Error(fmt::format("rows: the starts have shape {}; give a stream of one dimension, with one "
                              "element more than there are rows",
                              toString(region.shape)),
                  Error::Kind::Shape);
    }
    auto starts = detail::hostVector<std::int32_t>(static_cast<std::size_t>(region.shape.size()));
    detail::read(region, starts.data(), starts.size());
    checkStarts(starts);
    return RowsOwner(new RowsState(*stream.device, std::move(starts)));
  });
}

const RowsState& detail::checked(const RowsOwner& rows) {
  if (rows) return *rows;
  throw Error("rows: they were moved from; make others, sk::Rows rows(starts)", Error::Kind::Lost);
}

std::int64_t Rows::count() const { return detail::checked(state_).rows(); }
std::int64_t Rows::end() const { return detail::checked(state_).end(); }

}  // namespace sk
