// SPDX-License-Identifier: MIT
//
// Implements sk::Scalar: collects operations, and gives them to the device in passes. What writes a scalar asks for its
// region first, which carries out all operations that were asked for before; so none reads a value that came later.
#include "sk/scalar.hpp"

#include <algorithm>
#include <cstring>
#include <exception>
#include <unordered_set>
#include <utility>

#include <fmt/format.h>

#include "call/check_written.hpp"
#include "device/device_state.hpp"
#include "device/loop_state.hpp"
#include "device/scalar_pass.hpp"
#include "results/recorder.hpp"
#include "sk/error.hpp"
#include "support/checked_size.hpp"

namespace sk {

/// An operation as a scalar of the application holds it.
struct detail::PendingScalar {
  PendingScalar(std::shared_ptr<ScalarNode> held, const ScalarHandle& holder) : node(std::move(held)) {
    node->holder = &holder;
  }
  ~PendingScalar() { node->holder = nullptr; }
  PendingScalar(const PendingScalar&) = delete;
  PendingScalar& operator=(const PendingScalar&) = delete;

  const std::shared_ptr<ScalarNode> node;
};

void detail::PendingScalarDeleter::operator()(PendingScalar* pending) const noexcept { delete pending; }

namespace {

using detail::ScalarOp;
using Nodes = std::vector<std::shared_ptr<ScalarNode>>;

[[noreturn]] void failWithoutValue() {
  throw Error(
      "a scalar: it holds no value, since it was default-constructed or moved from; make one by "
      "device.scalar<T>()",
      Error::Kind::Lost);
}

[[noreturn]] void failForDevice() {
  throw Error("a scalar: its device has been destroyed; keep the device for as long as its scalars are used",
              Error::Kind::Lost);
}

/// Writes operations as the steps of a pass.
class PassBuilder {
 public:
  explicit PassBuilder(std::span<const std::shared_ptr<ScalarNode>> nodes) {
    for (const std::shared_ptr<ScalarNode>& node : nodes) {
      const std::uint32_t step = stepOf(*node).index;
      StreamState* const stream = node->target != nullptr ? node->target : node->result.get();
      pass.outputs.push_back({stream, step});
    }
  }

  ScalarPass pass;

 private:
  ScalarRef stepOf(const ScalarNode& node) {
    const auto known = std::ranges::find(known_, &node, &std::pair<const ScalarNode*, ScalarRef>::first);
    if (known != known_.end()) return known->second;
    ScalarStep step{node.op, node.type, node.element, {}};
    for (std::size_t i = 0; i < node.operands.size(); ++i) step.operands[i] = refOf(node.operands[i]);
    pass.steps.push_back(step);
    known_.emplace_back(&node,
                        ScalarRef{ScalarRef::Kind::Step, static_cast<std::uint32_t>(pass.steps.size() - 1)});
    return known_.back().second;
  }

  ScalarRef refOf(const ScalarNode::Operand& operand) {
    if (operand.node) return stepOf(*operand.node);  // again, if an earlier pass has its result
    if (operand.stream != nullptr) return readOf(operand.stream);
    pass.numbers.push_back(operand.number);
    return {ScalarRef::Kind::Number, static_cast<std::uint32_t>(pass.numbers.size() - 1)};
  }

  ScalarRef readOf(StreamState* stream) {
    auto found = std::ranges::find(pass.reads, stream, &StreamRegion::stream);
    if (found == pass.reads.end()) {
      pass.reads.push_back({stream, Index::origin(stream->shape.rank()), stream->shape});
      found = pass.reads.end() - 1;
    }
    return {ScalarRef::Kind::Read, static_cast<std::uint32_t>(found - pass.reads.begin())};
  }

  std::vector<std::pair<const ScalarNode*, ScalarRef>> known_;
};

constexpr std::string_view aScalar = "a scalar";

void checkPass(const ScalarPass& pass) {
  for (const StreamRegion& read : pass.reads) checkNotLost(read, false, aScalar);
}

/// A pass with SK_CHECK=written, which is checked each time that it runs.
class CheckedScalars final : public RecordedCall {
 public:
  CheckedScalars(std::unique_ptr<RecordedCall> call, const ScalarPass& pass)
      : call_(std::move(call)), reads_(pass.reads), outputs_(pass.outputs) {}

  void run() override {
    for (const StreamRegion& read : reads_) checkWritten(read, aScalar);
    call_->run();
    for (const ScalarPass::Output& output : outputs_) noteAllWritten(*output.stream);
  }
  std::string_view name() const override { return operationsName; }

 private:
  std::unique_ptr<RecordedCall> call_;
  std::vector<StreamRegion> reads_;
  std::vector<ScalarPass::Output> outputs_;
};

std::unique_ptr<RecordedCall> prepared(DeviceState& device, ScalarPass pass) {
  if (!checksWritten()) return device.prepareScalars(std::move(pass));
  std::unique_ptr<RecordedCall> call = device.prepareScalars(pass);
  return std::make_unique<CheckedScalars>(std::move(call), pass);
}

void noteUses(const ScalarPass& pass, LoopState& loop) {
  for (const StreamRegion& read : pass.reads) loop.use(read.stream);
  for (const ScalarPass::Output& output : pass.outputs) loop.use(output.stream);
}

void runPass(DeviceState& device, std::span<const std::shared_ptr<ScalarNode>> nodes) {
  if (nodes.empty()) return;
  for (const std::shared_ptr<ScalarNode>& node : nodes) {
    if (node->target != nullptr) continue;
    node->result = detail::StreamOwner(device.createStream(*node->element, {1}, Storage::Single).release());
    node->result.get()->resultNumber = results::Recorder::scalarNumber;
  }
  PassBuilder builder(nodes);
  checkPass(builder.pass);
  if (device.recording != nullptr) noteUses(builder.pass, *device.recording);
  std::unique_ptr<RecordedCall> call = prepared(device, std::move(builder.pass));
  if (device.recording != nullptr) {
    device.recording->add(std::move(call));
  } else {
    const TraceScope traced(device.trace.get(), "call", "scalars");
    call->run();
  }
  for (const std::shared_ptr<ScalarNode>& node : nodes) {
    node->state = ScalarNode::State::Done;
    if (node->holder != nullptr) node->holder->takeStream();  // a recording knows scalars by their streams
  }
}

/// Marks operations as lost that an exception keeps from being done.
class LostUnlessDone {
 public:
  explicit LostUnlessDone(const Nodes& nodes) : nodes_(nodes) {}
  ~LostUnlessDone() {
    for (const std::shared_ptr<ScalarNode>& node : nodes_) {
      if (node->state == ScalarNode::State::Pending) node->state = ScalarNode::State::Lost;
    }
  }
  LostUnlessDone(const LostUnlessDone&) = delete;
  LostUnlessDone& operator=(const LostUnlessDone&) = delete;

 private:
  const Nodes& nodes_;
};

bool isPending(const std::shared_ptr<ScalarNode>& node) {
  return node->holder != nullptr && node->state == ScalarNode::State::Pending;
}

/// Whether an operation that is held reads the stream, itself or through its operands, which come before it.
bool isRead(const Nodes& nodes, const StreamState* stream) {
  std::unordered_set<const ScalarNode*> needed;
  for (auto node = nodes.rbegin(); node != nodes.rend(); ++node) {
    if (!isPending(*node) && !needed.contains(node->get())) continue;
    for (const ScalarNode::Operand& operand : (*node)->operands) {
      if (operand.node) {
        needed.insert(operand.node.get());
      } else if (operand.stream == stream) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

// Results that get new streams come first, since what others overwrite must be read before; these are few enough for
// one pass (ScalarHandle::assign).
void flushScalars(DeviceState& device) {
  const PendingScalars pending = std::exchange(device.pendingScalars, {});
  Nodes created, assigned;
  const LostUnlessDone guard(pending.nodes);
  for (const std::shared_ptr<ScalarNode>& node : pending.nodes) {
    if (isPending(node)) (node->target == nullptr ? created : assigned).push_back(node);
  }
  if (created.size() + assigned.size() <= mostScalarOutputs) {
    created.insert(created.end(), assigned.begin(), assigned.end());
    assigned.clear();
  }
  const std::span<const std::shared_ptr<ScalarNode>> all = created;
  for (std::size_t first = 0; first < all.size(); first += mostScalarOutputs) {
    runPass(device, all.subspan(first, std::min(mostScalarOutputs, all.size() - first)));
  }
  runPass(device, assigned);
}

namespace detail {

ScalarHandle::ScalarHandle(ScalarOp op, const program::Element& result,
                           std::span<const ScalarTerm> operands) {
  withHostMemory("a scalar", [&] {
    auto node = std::make_shared<ScalarNode>();
    node->op = op;
    node->element = &result;
    node->type = operands.back().element->fields.front().scalar;
    for (const ScalarTerm& term : operands) {
      if (term.scalar == nullptr) continue;
      if (!term.scalar->exists()) failWithoutValue();
      term.scalar->takeResult();
      DeviceState* const device =
          term.scalar->pending_ ? term.scalar->pending_->node->device : term.scalar->stream_->device;
      if (device == nullptr) failForDevice();
      if (node->device != nullptr && node->device != device) {
        throw Error(fmt::format("a scalar: its operands are on two devices ('{}' and '{}'); read one of them",
                                node->device->name(), device->name()),
                    Error::Kind::Device);
      }
      node->device = device;
    }
    node->device->checkProcess();
    // now, lest others that are pending with it are lost
    for (const ScalarTerm& term : operands) {
      if (!checksWritten() || node->device->recording != nullptr) break;
      if (term.scalar != nullptr && !term.scalar->pending_)
        checkWritten(wholeRegion(term.scalar->stream_.get()), aScalar);
    }
    PendingScalars& all = node->device->pendingScalars;
    if (all.reads + operands.size() > mostScalarReads || all.steps == mostScalarSteps)
      flushScalars(*node->device);
    for (const ScalarTerm& term : operands) {
      if (term.scalar != nullptr) term.scalar->takeResult();
      ScalarNode::Operand operand;
      if (term.scalar == nullptr) {
        operand.number.element = term.element;
        std::memcpy(operand.number.value.data(), term.number, term.element->size);
      } else if (term.scalar->pending_) {
        operand.node = term.scalar->pending_->node;
      } else {
        operand.stream = term.scalar->stream_.get();
        ++all.reads;
      }
      node->operands.push_back(std::move(operand));
    }
    ++all.steps;
    all.nodes.push_back(node);
    pending_ = Owner<PendingScalar, PendingScalarDeleter>(new PendingScalar(std::move(node), *this));
  });
}

ScalarHandle& ScalarHandle::operator=(ScalarHandle&& other) {
  if (this == &other) return *this;
  if (stream_ && stream_->device != nullptr && other.pending_ && !other.stream_) {
    assign(other, *other.pending_->node->element);
    other.pending_ = {};
    return *this;
  }
  end();
  stream_ = std::move(other.stream_);
  pending_ = std::move(other.pending_);
  if (pending_) hold();
  return *this;
}

void ScalarHandle::hold() noexcept { pending_->node->holder = this; }

void ScalarHandle::assign(const ScalarHandle& value, const program::Element& element) {
  if (!exists()) failWithoutValue();
  if (this == &value) return;
  if (!stream_) static_cast<void>(region());
  if (stream_->device == nullptr) failForDevice();
  withHostMemory("a scalar", [&] {
    const auto isAssigned = [](const std::shared_ptr<ScalarNode>& node) {
      return isPending(node) && node->target != nullptr;
    };
    DeviceState& device = *stream_->device;
    if (std::ranges::count_if(device.pendingScalars.nodes, isAssigned) ==
        static_cast<std::ptrdiff_t>(mostScalarOutputs)) {
      flushScalars(device);
    }
    const ScalarTerm term{&value, nullptr, &element};
    ScalarHandle copy(ScalarOp::Copy, element, {&term, 1});
    if (copy.pending_->node->device != stream_->device) {
      throw Error("a scalar: a value of another device is assigned to it; read that one",
                  Error::Kind::Device);
    }
    copy.pending_->node->target = stream_.get();
    pending_ = std::move(copy.pending_);
    hold();
  });
}

bool ScalarHandle::takeStream() const noexcept {
  if (!pending_ || pending_->node->state == ScalarNode::State::Pending) return true;
  ScalarNode& node = *pending_->node;
  // A recording that is given up has returned the stream that this handle held before the operation.
  const bool isReturned = node.target == nullptr && stream_;
  if (node.state == ScalarNode::State::Lost && !isReturned) return false;
  if (node.result) stream_ = std::move(node.result);
  pending_ = {};
  return true;
}

/// Takes the result of an operation that has been carried out.
void ScalarHandle::takeResult() const {
  if (takeStream()) return;
  throw Error("a scalar: its value is lost, since what computed it has failed; make another",
              Error::Kind::Lost);
}

StreamRegion ScalarHandle::region() const {
  DeviceState* const device = pending_ ? pending_->node->device : stream_ ? stream_->device : nullptr;
  if (pending_ && device == nullptr) failForDevice();
  if (device != nullptr) withHostMemory("a scalar", [&] { flushScalars(*device); });
  takeResult();
  return wholeRegion(stream_.get());
}

void ScalarHandle::end() noexcept {
  pending_ = {};
  if (!stream_ || stream_->device == nullptr) return;
  const Nodes& nodes = stream_->device->pendingScalars.nodes;
  try {
    if (!isRead(nodes, stream_.get())) return;
    flushScalars(*stream_->device);
  } catch (const std::exception&) {
    // the scalars that needed it say that their values are lost
  }
}

}  // namespace detail

}  // namespace sk
