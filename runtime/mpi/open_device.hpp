// SPDX-License-Identifier: MIT
//
// Chooses the device of a rank.
#pragma once

#include "messages.hpp"
#include "sk/device.hpp"

namespace sk::mpi {

/// Opens the device that the options or SK_DEVICE name; else a GPU of the host, of which ranks take turns; else the best
/// device there is. Collective.
Device openDevice(MPI_Comm communicator, const DeviceOptions& options);

}  // namespace sk::mpi
