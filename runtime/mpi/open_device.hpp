// SPDX-License-Identifier: MIT
//
// Chooses the device of a rank.
#pragma once

#include "domain_state.hpp"

namespace sk::mpi {

/// Opens the device that the options or SK_DEVICE name; else a GPU of the host, of which ranks take turns; else the best
/// device there is. Collective: throws sk::Error on all ranks if one has no such device, or if some compute natively and others do not.
void openDevice(std::shared_ptr<RankDevice>& device, Agreement& agreement, const DeviceOptions& options);

}  // namespace sk::mpi
