// SPDX-License-Identifier: MIT
//
// Also implements sk::Domain, which forwards to its state.

#include "domain_state.hpp"

#include <algorithm>
#include <cstdlib>
#include <optional>
#include <span>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "agreement.hpp"
#include "call_details.hpp"
#include "device/configuration.hpp"
#include "device/stream_state.hpp"
#include "open_device.hpp"
#include "sk/error.hpp"
#include "sk/limits.hpp"
#include "sk/linked_file.hpp"

namespace sk {

using domain::Depth;

std::uint64_t ObjectNumbers::of(const void* descriptor) {
  if (unloads_.hasChanged()) numbers_.clear();
  const auto [known, isNew] = numbers_.try_emplace(descriptor, 0);
  if (isNew) known->second = program::LinkedFile::objectOf(descriptor);
  return known->second;
}

const program::Reduction& Combinations::of(const program::Reduction& reduction, DeviceState& device) {
  if (unloads_.hasChanged()) {
    std::erase_if(made_, [&](const auto& entry) {
      if (program::LinkedFile::isLoaded(entry.second.object)) return false;
      device.forget(entry.second.combination->reduction);
      return true;
    });
  }
  Made& made = made_[&reduction];
  if (made.combination == nullptr)
    made = {std::make_unique<mpi::Combination>(reduction), program::LinkedFile::objectOf(&reduction)};
  return made.combination->reduction;
}

namespace {

/// A launcher that this program's MPI does not understand starts each process as a world of its own.
void checkLauncher(int ranks) {
  if (ranks > 1) return;
  for (const char* variable :
       {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "MPI_LOCALNRANKS", "SLURM_STEP_NUM_TASKS"}) {
    const char* const told = std::getenv(variable);
    if (told == nullptr || std::atoi(told) <= 1) continue;
    throw Error(fmt::format("sk::Domain: the launcher has started {} processes "
                            "({}), but MPI sees 1 rank: this program was "
                            "built with another MPI; start it with the mpirun "
                            "of that MPI, or with srun --mpi=pmix",
                            told, variable),
                Error::Kind::Misuse);
  }
}

/// What can only be checked before ranks can be compared.
void checkMpi(MPI_Comm communicator) {
  int isThere = 0;
  MPI_Initialized(&isThere);
  if (isThere == 0)
    throw Error(
        "sk::Domain: MPI has not been initialized; call MPI_Init before, and MPI_Finalize after the domain "
        "ends");
  MPI_Finalized(&isThere);
  if (isThere != 0) throw Error("sk::Domain: MPI_Finalize has been called; create the domain before");
  if (communicator == MPI_COMM_NULL)
    throw Error("sk::Domain: the communicator is MPI_COMM_NULL; give one of this rank's");
  int world = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &world);
  checkLauncher(world);
}

domain::Decomposition decompose(const DomainOptions& options, int ranks) {
  const Shape& shape = options.shape;
  const auto refuse = [&](const std::string& why) {
    throw Error(fmt::format("sk::Domain: {}", why), Error::Kind::Shape);
  };
  if (shape.size() == 0)
    refuse(fmt::format("the shape {} has no element; give extents of at least 1", toString(shape)));
  for (int d = 0; d < shape.rank(); ++d) {
    if (shape[d] > mostExtent)
      refuse(
          fmt::format("the shape {} has an extent above {}, where indices "
                      "end; give it more dimensions",
                      toString(shape), mostExtent));
  }
  if (options.exchangeEvery < 1)
    refuse(fmt::format("exchangeEvery is {}; it counts calls, from 1 on", options.exchangeEvery));
  if (options.split.rank() == 0) {
    const std::optional<Index> split = domain::balancedSplit(shape, ranks);
    if (!split)
      refuse(
          fmt::format("a domain of shape {} cannot be divided over {} ranks "
                      "so that each has an element; start fewer",
                      toString(shape), ranks));
    return {shape, *split, options.periodic};
  }
  const Index& split = options.split;
  if (split.rank() != shape.rank())
    refuse(
        fmt::format("the split {} has {} dimensions, but the shape {} has "
                    "{}; give one number of parts for each",
                    toString(split), split.rank(), toString(shape), shape.rank()));
  std::int64_t product = 1;
  for (int d = 0; d < split.rank(); ++d) {
    if (split[d] < 1 || split[d] > shape[d])
      refuse(
          fmt::format("the split {} has {} parts in dimension {}, where the "
                      "shape {} has {} elements; give 1 to {}",
                      toString(split), split[d], d, toString(shape), shape[d], shape[d]));
    product *= split[d];
    if (product > ranks) break;
  }
  if (product != ranks)
    refuse(
        fmt::format("the split {} has not as many parts as there are ranks, "
                    "{}; start another number of ranks, or leave "
                    "the split out",
                    toString(split), ranks));
  return {shape, split, options.periodic};
}

std::uint64_t hashOf(const DomainOptions& options) {
  mpi::Hash hash;
  hash.add(options.shape.rank());
  hash.add(options.split.rank());
  for (int d = 0; d < options.shape.rank(); ++d) {
    hash.add(options.shape[d]);
    hash.add(options.periodic[static_cast<std::size_t>(d)] ? 1 : 0);
  }
  for (int d = 0; d < options.split.rank(); ++d) hash.add(options.split[d]);
  hash.add(options.exchangeEvery);
  return hash.value();
}

std::string nameOf(const DomainOptions& options) {
  const auto dimensions = std::span(options.periodic).first(static_cast<std::size_t>(options.shape.rank()));
  return fmt::format("a domain of shape {}, split {}, periodic {{{}}}, exchangeEvery {}",
                     toString(options.shape), toString(options.split), fmt::join(dimensions, ", "),
                     options.exchangeEvery);
}

/// The options of a domain beside another one: parts are those of the other one, if the options do not say how to divide.
DomainOptions optionsBeside(const DomainState& other, DomainOptions options) {
  if (options.split.rank() != 0) return options;
  const Index& split = other.parts.split();
  Index same = Index::origin(options.shape.rank());
  for (int d = 0; d < same.rank(); ++d) {
    const int k = split.rank() - same.rank() + d;
    same[d] = k < 0 ? 1 : split[k];
  }
  options.split = same;
  return options;
}

}  // namespace

/// What all ranks have agreed on before a domain is made.
struct DomainState::Start {
  std::shared_ptr<mpi::Agreement> agreement;
  DomainOptions options;
  std::optional<domain::Decomposition> parts;
  std::shared_ptr<RankDevice> rankDevice;
  mpi::Communicator communicator{MPI_COMM_NULL};
};

detail::DomainOwner DomainState::create(MPI_Comm given, const DomainOptions& chosen) {
  checkMpi(given);
  Start start;
  std::string name;
  const mpi::Refusal refusal = mpi::caught("sk::Domain", [&] {
    start.agreement = std::make_shared<mpi::Agreement>();
    int ranks = 0;
    mpi::check(MPI_Comm_size(given, &ranks), "sk::Domain");
    start.agreement->reserve(ranks);
    start.options = chosen;
    name = nameOf(chosen);
  });
  mpi::Agreement without;
  mpi::Agreement& agreement = start.agreement ? *start.agreement : without;
  agreement.open(given, refusal);
  agreement.count();
  agreement.together({name, hashOf(chosen)}, [&] {
    agreement.readEnvironment();
    start.parts = decompose(chosen, agreement.ranks());
  });
  mpi::openDevice(start.rankDevice, agreement, chosen.device);
  return finish(start, given);
}

detail::DomainOwner DomainState::createBeside(const DomainState& beside, const DomainOptions& chosen) {
  Start start;
  start.agreement = beside.sharedAgreement;
  start.rankDevice = beside.rankDevice;
  mpi::Agreement& agreement = *start.agreement;
  std::string name;
  const mpi::Refusal refusal = mpi::caught("sk::Domain", [&] { name = nameOf(chosen); });
  agreement.count();
  agreement.together({name, hashOf(chosen)}, [&] {
    if (refusal) throw Error(*refusal);
    start.options = optionsBeside(beside, chosen);
    start.parts = decompose(start.options, agreement.ranks());
  });
  return finish(start, beside.communicator);
}

detail::DomainOwner DomainState::finish(Start& start, MPI_Comm communicator) {
  const int status =
      start.communicator.become([&](MPI_Comm* copy) { return MPI_Comm_dup(communicator, copy); });
  const std::shared_ptr<mpi::Agreement> agreement = start.agreement;  // a domain that fails destroys its own
  detail::DomainOwner state = agreement->together({"a domain"}, [&] {
    mpi::check(status, "sk::Domain");
    MPI_Comm_set_errhandler(start.communicator, MPI_ERRORS_RETURN);
    return detail::DomainOwner(new DomainState(start));
  });
  state->number = agreement->nextDomain();
  return state;
}

DomainState::DomainState(Start& start)
    : sharedAgreement(std::move(start.agreement)),
      agreement(*sharedAgreement),
      communicator(std::move(start.communicator)),
      rank(agreement.rank()),
      options(start.options),
      parts(*start.parts),
      own(parts.boxOf(rank)),
      directions(domain::directionsOf(parts)),
      rankDevice(std::move(start.rankDevice)),
      device(rankDevice->device),
      sendBuffers(directions.size()),
      receiveBuffers(directions.size()) {
  agreement.join(*this);
}

DomainState::~DomainState() {
  endPending();
  agreement.leave(*this);
  for (DomainStreamState* stream : streams) stream->domain = nullptr;
}

void DomainState::forget() noexcept {
  for (DomainStreamState* stream : streams) stream->valid = {};
}

detail::DomainStreamOwner DomainState::createStream(const program::Element& element, Storage storage,
                                                    std::string_view name) {
  const auto create = [&] {
    return detail::DomainStreamOwner(new DomainStreamState(*this, element, storage, name));
  };
  detail::DomainStreamOwner stream;
  agreement.count();
  if (agreement.isAlways()) {
    mpi::StreamCall call("a stream", *this);
    call.with("elements", element.name).with("storage", sk::nameOf(storage));
    stream = agreement.together(call.call(), create);
  } else {
    agreement.act("a stream of a domain", [&] { stream = create(); });
  }
  stream->number = ++streamCount;
  return stream;
}

const mpi::Communicator& DomainState::lineOf(int dimension) {
  std::optional<mpi::Communicator>& known = lines_[static_cast<std::size_t>(dimension)];
  if (known) return *known;
  const Index place = parts.placeOf(rank);
  int color = 0;
  for (int d = 0; d < place.rank(); ++d) {
    if (d != dimension) color = color * static_cast<int>(parts.split()[d]) + static_cast<int>(place[d]);
  }
  MPI_Comm made = MPI_COMM_NULL;
  const int status = MPI_Comm_split(communicator, color, static_cast<int>(place[dimension]), &made);
  mpi::Communicator line(made);
  agreement.together({"the ranks along a dimension"}, [&] {
    mpi::check(status, "the ranks along a dimension");
    MPI_Comm_set_errhandler(line, MPI_ERRORS_RETURN);
  });
  return known.emplace(std::move(line));  // on all ranks or on none
}

DomainStreamState* domainStream(const StreamRegion& region) {
  auto* const stream = static_cast<DomainStreamState*>(region.distributed);
  if (stream != nullptr && stream->domain == nullptr) {
    throw Error(
        "the sk::Domain of a stream has been destroyed; keep the "
        "domain for as long as its streams are used",
        Error::Kind::Lost);
  }
  return stream;
}

DomainStreamState& liveStream(DomainStreamState* stream, std::string_view what) {
  if (stream == nullptr) {
    throw Error(fmt::format("{}: there is no stream: it was "
                            "default-constructed or moved from; make one by "
                            "domain.stream<T>()",
                            what),
                Error::Kind::Lost);
  }
  domainStream({.distributed = stream});
  return *stream;
}

DomainStreamState::DomainStreamState(DomainState& of, const program::Element& type, Storage storage,
                                     std::string_view name)
    : domain(&of), element(type), storage_(storage), name_(name), local_(create()) {
  domain->streams.push_back(this);
}

DomainStreamState::~DomainStreamState() {
  if (domain != nullptr) std::erase(domain->streams, this);
}

detail::Distribution& DomainStreamState::distribution() {
  domainStream({.distributed = this});
  return *domain;
}

detail::StreamOwner DomainStreamState::create() const {
  const Depth halo = domain->parts.haloOf(domain->rank, allocated);
  detail::StreamOwner created = domain->device.createStream(
      element, domain::shapeOf(domain::grown(domain->own, halo)), storage_, name_);
  // Other ranks' elements come and go unseen.
  if (created->unwritten != nullptr) created->unwritten->countTogether();
  return created;
}

StreamRegion DomainStreamState::placed(StreamState* state) const {
  const Depth halo = domain->parts.haloOf(domain->rank, allocated);
  return detail::placed(detail::wholeRegion(state),
                        {domain::grown(domain->own, halo).begin, domain->parts.whole()});
}

StreamRegion DomainStreamState::placed() const { return placed(local_.get()); }

StreamRegion DomainStreamState::part(const Box& box) const { return part(local_.get(), box); }

StreamRegion DomainStreamState::part(StreamState* state, const Box& box) const {
  const Box held = domain::grown(domain->own, domain->parts.haloOf(domain->rank, allocated));
  Box local = box;
  for (int d = 0; d < box.begin.rank(); ++d) {
    local.begin[d] -= held.begin[d];
    local.end[d] -= held.begin[d];
  }
  return detail::partOf(detail::wholeRegion(state), local.begin, local.end);
}

void DomainStreamState::deepen(const Depth& depth) {
  if (allocated.covers(depth)) return;
  const Depth before = allocated;
  const Box kept = domain::grown(domain->own, domain->parts.haloOf(domain->rank, valid));
  const StreamRegion from = part(kept);
  allocated = allocated.with(depth);
  detail::StreamOwner deeper;
  try {
    deeper = create();
    if (from.stream->isLost()) {
      deeper->markLost();
    } else if (from.stream->unwritten == nullptr || !from.stream->unwritten->isAll()) {
      detail::copy(from, part(deeper.get(), kept));
    }
  } catch (...) {
    allocated = before;
    throw;
  }
  local_ = std::move(deeper);
  spare_ = {};
}

StreamRegion DomainStreamState::spare() {
  if (!spare_) spare_ = create();
  spare_->setWritten();  // a call that has failed may have left it lost, but nothing of it is read
  return placed(spare_.get());
}

void DomainStreamState::exchange() { std::swap(local_, spare_); }

namespace {

DomainState& live(const detail::DomainOwner& state) {
  if (!state)
    throw Error("the sk::Domain was moved from; use the one that it was moved to", Error::Kind::Lost);
  return *state;
}

}  // namespace

void detail::DomainDeleter::operator()(DomainState* state) const noexcept { delete state; }
void detail::DomainDeleter::operator()(DomainStreamState* state) const noexcept { delete state; }

Domain::Domain(MPI_Comm communicator, const DomainOptions& options)
    : state_(DomainState::create(communicator, options)) {}

Domain::Domain(const Domain& beside, const DomainOptions& options)
    : state_(DomainState::createBeside(live(beside.state_), options)) {}

detail::DomainStreamOwner Domain::createStream(const program::Element& element, Storage storage,
                                               std::string_view name) {
  return live(state_).createStream(element, storage, name);
}

const Shape& Domain::shape() const { return live(state_).parts.whole(); }
const Index& Domain::split() const { return live(state_).parts.split(); }
int Domain::rank() const { return live(state_).rank; }
int Domain::ranks() const { return live(state_).parts.ranks(); }
MPI_Comm Domain::communicator() const { return live(state_).communicator; }
Device& Domain::device() { return live(state_).device; }

Box Domain::own(int rank) const {
  const DomainState& state = live(state_);
  if (rank < 0 || rank >= state.parts.ranks())
    throw Error("Domain::own: there is no such rank; ranks() says how many there are");
  return state.parts.boxOf(rank);
}

const DomainStatistics& Domain::statistics() const { return live(state_).statistics; }
void Domain::resetStatistics() { live(state_).statistics = {}; }

}  // namespace sk
