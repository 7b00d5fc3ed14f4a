// SPDX-License-Identifier: MIT
#include "open_device.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "gl/displays.hpp"
#include "sk/error.hpp"

namespace sk::mpi {

namespace {

/// The number of this rank among those on its host.
int localRank(MPI_Comm communicator) {
  MPI_Comm host = MPI_COMM_NULL;
  check(MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &host), "sk::Domain");
  int rank = 0;
  check(MPI_Comm_rank(host, &rank), "sk::Domain");
  MPI_Comm_free(&host);
  return rank;
}

int gpuCount() {
  if (!gl::whyNoEglLibrary().empty()) return 0;
  return static_cast<int>(
      std::ranges::count_if(gl::displayCandidates(), [](const gl::DisplayCandidate& candidate) {
        return candidate.kind == gl::DisplayCandidate::Kind::Device && !candidate.isSoftware;
      }));
}

/// Throws on all ranks if a rank has no device, so that none waits for it.
void checkAll(MPI_Comm communicator, const std::optional<Error>& error) {
  int rank = 0, failed = 0;
  check(MPI_Comm_rank(communicator, &rank), "sk::Domain");
  const int own = error ? rank + 1 : 0;
  check(MPI_Allreduce(&own, &failed, 1, MPI_INT, MPI_MAX, communicator), "sk::Domain");
  if (failed == 0) return;
  if (error)
    throw Error(fmt::format("sk::Domain: rank {} has no device: {}", rank, error->what()), error->kind());
  throw Error(fmt::format("sk::Domain: rank {} has no device; its own message says why", failed - 1),
              Error::Kind::Device);
}

}  // namespace

Device openDevice(MPI_Comm communicator, const DeviceOptions& options) {
  const int number = localRank(communicator);
  const char* const named = std::getenv("SK_DEVICE");
  const bool isNamed = !options.device.empty() || (named != nullptr && *named != '\0');
  const int gpus = isNamed ? 0 : gpuCount();
  DeviceOptions own = options;
  if (gpus > 1) own.device = "gpu:" + std::to_string(number % gpus);
  std::optional<Device> device;
  std::optional<Error> error;
  try {
    device.emplace(own);
  } catch (const Error& thrown) {
    error = thrown;
  }
  checkAll(communicator, error);
  return std::move(*device);
}

}  // namespace sk::mpi
