// SPDX-License-Identifier: MIT
#include "open_device.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <string>
#include <utility>

#include "agreement.hpp"
#include "device/device_state.hpp"
#include "device/stream_state.hpp"
#include "gl/open_context.hpp"

namespace sk::mpi {

namespace {

/// The ranks on one host.
struct Host {
  /// Collective.
  explicit Host(MPI_Comm all)
      : ranks(MPI_COMM_NULL), status(ranks.become([&](MPI_Comm* made) {
          return MPI_Comm_split_type(all, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, made);
        })) {}
  /// The number of this rank among them.
  int rank() const {
    check(status, "the device of a sk::Domain");
    int number = 0;
    check(MPI_Comm_rank(ranks, &number), "the device of a sk::Domain");
    return number;
  }

  Communicator ranks;
  int status;
};

int gpuCount() {
  if (!gl::whyNoEglLibrary().empty()) return 0;
  return static_cast<int>(
      std::ranges::count_if(gl::displayCandidates(), [](const gl::DisplayCandidate& candidate) {
        return candidate.kind == gl::DisplayCandidate::Kind::Device && !candidate.isSoftware;
      }));
}

/// Whether the device's own programs reach host memory.
bool canStage(Device& device) {
  const detail::StreamOwner any = device.createStream(ElementTraits<float>::element(), {1});
  return any->device->makeStaging(Staging::Way::ToHost) != nullptr;
}

}  // namespace

void openDevice(std::shared_ptr<RankDevice>& device, Agreement& agreement, const DeviceOptions& options) {
  const Host host(agreement.communicator());
  std::string name;
  agreement.together({"the device of a sk::Domain"}, [&] {
    const char* const named = std::getenv("SK_DEVICE");
    const bool isNamed = !options.device.empty() || (named != nullptr && *named != '\0');
    const int number = host.rank(), gpus = isNamed ? 0 : gpuCount();
    DeviceOptions own = options;
    if (gpus > 1) own.device = "gpu:" + std::to_string(number % gpus);
    Device opened(own);
    const bool canItStage = canStage(opened);
    name = opened.profile() == "native" ? opened.name() : "OpenGL";
    device = std::make_shared<RankDevice>(RankDevice{.device = std::move(opened), .stagesHalos = canItStage});
  });
  Hash hash;
  hash.add(name);
  agreement.agree({name, hash.value()}, std::nullopt);
  device->stagesHalos = agreement.most(device->stagesHalos ? 0 : 1) == 0;
}

}  // namespace sk::mpi
