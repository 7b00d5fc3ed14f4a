// SPDX-License-Identifier: MIT
//
// Implements sk::Domain: forwards to its state.
#include "domain_state.hpp"
#include "sk/error.hpp"

namespace sk {

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
