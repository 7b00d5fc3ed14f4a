// SPDX-License-Identifier: MIT
//
// Everything that may fail precedes changes of streams. A stream that the call scatters to and reads is scattered to in
// new planes, which take its place.
#include "gl_device/append/append_dispatch.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "assemble/append/append_groups.hpp"
#include "assemble/append/append_passes.hpp"
#include "call/check_call.hpp"
#include "device/write_scope.hpp"
#include "gl_device/append/append_call.hpp"
#include "gl_device/append/histo_pyramid.hpp"
#include "gl_device/append/scatter_lists.hpp"
#include "gl_device/gl_device.hpp"
#include "gl_device/gl_stream.hpp"
#include "gl_device/pass/output_targets.hpp"
#include "gl_device/pass/pass.hpp"
#include "gl_device/pass/pass_trace.hpp"

namespace sk {

namespace {

using assemble::GroupStep;
using assemble::Task;
using assemble::Work;
using program::Parameter;
using program::Role;

/// The list of a variable output, or of the records of a scatter output.
struct GroupList {
  explicit GroupList(GlDevice& device) : planes(device.memory()), total(device.memory()) {}

  std::size_t parameter = 0;
  bool isOfRecords = false;
  std::int64_t length = -1;  ///< entries that it has room for; -1: the pushes must be counted
  Layout layout;
  PlanesLease planes;
  PlanesLease total;  ///< a texture of one texel whose fourth channel is the number of pushes
  std::optional<ListedScatter> records;  ///< in place of `planes`, unless there are none
};

/// A scatter output.
struct GroupTarget {
  explicit GroupTarget(GlDevice& device) : copy(device.memory()) {}

  std::size_t parameter = 0;
  std::int64_t firstOwner = -1;  ///< in the buffer of states; -1: there are no owners
  PlanesLease copy;  ///< planes that take the place of the stream's, which the call reads; or none
};

class AppendDispatch {
 public:
  AppendDispatch(GlDevice& device, const ResolvedCall& call)
      : device_(device), call_(call), operands_(appendOperands(call)), layout_(chooseLayout()) {
    const std::int64_t elements = call.domain.size();
    for (std::size_t i = 0; i < call.arguments.size(); ++i) {
      const Parameter& parameter = call.kernel.parameters[i];
      const bool isOfRecords = isScattered(call, i) && assemble::isListed(parameter, call.options.order);
      if (parameter.role == Role::VariableOutput || isOfRecords) {
        lists_.push_back(std::make_unique<GroupList>(device));
        lists_.back()->parameter = i;
        lists_.back()->isOfRecords = isOfRecords;
        if (hasRoom(parameter, elements, device.limits.textureSize))
          lists_.back()->length = elements * parameter.pushes;
      } else if (isScattered(call, i)) {
        targets_.push_back(std::make_unique<GroupTarget>(device));
        targets_.back()->parameter = i;
      }
    }
    chooseTask();
    countStates();
  }

  bool isPossible() const {
    constexpr std::size_t buffers = 2;  // states, and the check of loops
    if (layout_.whole.layered || imageCount() > static_cast<std::size_t>(device_.limits.images) ||
        imageCount() + buffers > static_cast<std::size_t>(device_.capabilities.outputResources) ||
        !mayStore() || words_ * 4 > device_.capabilities.storageBytes || words_ > INT32_MAX) {
      return false;
    }
    const auto mayScatter = [&](const auto& target) {
      return !operands_[target->parameter].regionLayout.layered && isOnlyWriter(target->parameter);
    };
    const auto maySort = [&](const auto& list) {
      return !list->isOfRecords ||
             (mayScatter(list) &&
              ListedScatter::isPossible(device_, std::max<std::int64_t>(list->length, 1)));
    };
    return std::ranges::all_of(targets_, mayScatter) && std::ranges::all_of(lists_, maySort);
  }

  /// Returns false, before anything has an effect, if the lists need layers.
  bool run() {
    for (const auto& list : lists_)
      list->total.add(ElementTraits<int4>::element(), {1, 1}, "the number of pushes");
    KernelProgram& program =
        device_.programs().selected().kernelProgram(call_.kernel, operands_, layout_.whole, task_);
    const bool isCounted = std::ranges::any_of(lists_, [](const auto& list) { return list->length < 0; });
    if (isCounted) countPushes(program);
    for (const auto& list : lists_) {
      list->layout = listLayout(list->length, device_.textureLimits());
      const bool isPossible =
          !list->isOfRecords || ListedScatter::isPossible(device_, std::max<std::int64_t>(list->length, 1));
      if (list->layout.whole.layered || !isPossible) return false;
    }
    OutputTargets outputs(device_, call_.kernel, call_.arguments, call_.specs, operands_, layout_.whole,
                          layout_);
    for (const auto& target : targets_) copyIfRead(*target);
    for (const auto& list : lists_) takePlanes(*list);
    isCounted ? bindStatesAgain() : bindStates();
    findOwners();
    WriteScope writes;
    for (const auto& target : targets_) {
      if (target->copy.planes.empty()) writes.add(&streamOf(target->parameter));
    }
    outputs.begin();
    writes.begin();
    if (isCounted || lists_.empty() || mayWait()) {
      dispatch(program, task_, isCounted ? GroupStep::Store : GroupStep::All, &outputs);
    } else {
      dispatch(program, task_, GroupStep::Count);
      dispatch(program, task_, GroupStep::Scan);
      dispatch(program, task_, GroupStep::Store, &outputs);
    }
    outputs.copy();
    for (const auto& list : lists_) combineRecords(*list);
    outputs.exchange();
    writes.commit();
    for (const auto& target : targets_) settleTarget(*target);
    for (const auto& list : lists_) {
      if (!list->isOfRecords) settleList(*list);
    }
    return true;
  }

 private:
  GlStream& streamOf(std::size_t parameter) const { return glStream(call_.arguments[parameter].region); }

  /// Packed if the kernel reads packed elements of the domain.
  Layout chooseLayout() const {
    Layout layout = layoutOf(call_.domain, device_.textureLimits());
    if (!assemble::mayGroupPacked(call_.kernel) || !mayPack(call_.domain)) return layout;
    Layout packed = layoutOf(call_.domain, device_.textureLimits(), /*packed=*/true);
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const bool isInput = call_.kernel.parameters[i].role == Role::Input;
      if (isInput && !operands_[i].planes.empty() && haveSameTexels(operands_[i].regionLayout, packed.whole))
        return packed;
    }
    return layout;
  }

  void chooseTask() {
    const bool isAny = call_.options.order == Order::Any;
    const auto hasLength = [](const auto& list) { return list->length >= 0; };
    task_ = {.work = Work::Groups,
             .scattersInAnyOrder = isAny && hasScatters(),
             .pushesInAnyOrder =
                 isAny && !lists_.empty() && plan().isHeld && std::ranges::all_of(lists_, hasLength)};
    task_.inOneRound = plan().isHeld && rounds() < plan().rounds;
  }

  bool hasScatters() const {
    return !targets_.empty() ||
           std::ranges::any_of(lists_, [](const auto& list) { return list->isOfRecords; });
  }
  /// As programs see it, whose variant says it of scatter outputs alone.
  Order order() const {
    return call_.options.order == Order::Any && hasScatters() ? Order::Any : Order::Kept;
  }
  assemble::GroupPlan plan() const {
    return assemble::planGroups(call_.kernel, layout_.whole.packed, order());
  }

  /// Small domains are divided into enough tiles to occupy the device. Programs that hold values have one round or all.
  std::int32_t rounds() const {
    constexpr std::int64_t enoughTiles = 2048;
    const std::int64_t perTile = texels() / (enoughTiles * assemble::appendGroup);
    const std::int32_t most = plan().rounds;
    if (plan().isHeld) return 2 * perTile < most ? 1 : most;
    return static_cast<std::int32_t>(std::clamp<std::int64_t>(perTile, 1, most));
  }
  std::int64_t texels() const { return call_.domain.size() / (layout_.whole.packed ? assemble::lanes : 1); }
  std::int32_t texelsInRow() const {
    const assemble::RegionLayout& whole = layout_.whole;
    return whole.linear ? 1 << whole.shift : whole.extent[0] / (whole.packed ? assemble::lanes : 1);
  }
  std::int64_t tiles() const {
    const std::int64_t ofTile = std::int64_t{rounds()} * assemble::appendGroup;
    return (texels() + ofTile - 1) / ofTile;
  }

  /// Lays out the buffer of states: those of tiles, then owners.
  void countStates() {
    words_ = assemble::wordsBeforeStates + tiles() * static_cast<std::int64_t>(lists_.size());
    for (const auto& target : targets_) {
      if (!assemble::hasOwners(call_.kernel.parameters[target->parameter], order())) continue;
      const assemble::TextureShape& texture = streamOf(target->parameter).layout.texture;
      target->firstOwner = words_ - assemble::wordsBeforeStates;
      words_ += std::int64_t{texture.width} * texture.height;
    }
  }

  std::size_t imagesOf(const Parameter& written) const { return assemble::imagesOf(written, order()); }

  std::size_t imageCount() const {
    std::size_t count = lists_.size();
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Parameter& parameter = call_.kernel.parameters[i];
      const bool isWritten = parameter.role == Role::Output || assemble::isAppendOutput(parameter);
      if (isWritten && assemble::isNeeded(parameter, call_.specs)) count += imagesOf(parameter);
    }
    return count;
  }

  /// Whether the device's compute programs have images of all formats that are written, and the atomic operations.
  bool mayStore() const {
    const GlPrograms& programs = device_.programs();
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Parameter& parameter = call_.kernel.parameters[i];
      if (!assemble::isNeeded(parameter, call_.specs)) continue;
      const bool isStream = parameter.role == Role::Output || parameter.role == Role::Scatter;
      if (isStream && !programs.mayStore(streamOf(i).held())) return false;
      if (parameter.role == Role::VariableOutput && !programs.mayStore(*parameter.element)) return false;
    }
    const auto isAtomic = [&](const auto& target) {
      return call_.kernel.parameters[target->parameter].scatter != program::ScatterOp::Store;
    };
    return device_.capabilities.hasImageAtomics || std::ranges::none_of(targets_, isAtomic);
  }

  /// Whether no other output is a region of the same stream.
  bool isOnlyWriter(std::size_t scatter) const {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Role role = call_.kernel.parameters[i].role;
      const bool isWritten = role == Role::Output || role == Role::Scatter;
      if (i != scatter && isWritten &&
          call_.arguments[i].region.stream == call_.arguments[scatter].region.stream &&
          assemble::isNeeded(call_.kernel.parameters[i], call_.specs)) {
        return false;
      }
    }
    return true;
  }

  bool isRead(const StreamState* stream) const {
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Role role = call_.kernel.parameters[i].role;
      const bool reads = role == Role::Input || role == Role::Gather || role == Role::Uniform;
      if (reads && call_.arguments[i].region.stream == stream &&
          assemble::isNeeded(call_.kernel.parameters[i], call_.specs)) {
        return true;
      }
    }
    return false;
  }

  void copyIfRead(GroupTarget& target) {
    GlStream& stream = streamOf(target.parameter);
    if (!isRead(&stream) || stream.planes.empty()) return;
    target.copy.add(stream.held(), stream.layout.texture, "a scatter output that the kernel reads too");
    prepareCopy(device_, stream.held(), stream.layout.whole, stream.layout.whole);
    copyRegion(device_, stream.held(), stream.planes, stream.layout.whole, target.copy.planes,
               stream.layout.whole);
  }

  /// Whether a work group may wait for another. Software renderers end loops that take long.
  bool mayWait() const { return task_.pushesInAnyOrder || !device_.capabilities.isSoftware; }

  std::size_t bytesOfStates() const { return static_cast<std::size_t>(words_) * sizeof(std::uint32_t); }

  /// The room for records may have taken the buffer's binding.
  void bindStatesAgain() { device_.passes().bind(PassBuffer::GroupStates, bytesOfStates()); }

  void bindStates() {
    device_.passes().bind(PassBuffer::GroupStates, bytesOfStates(), call_.kernel,
                          "the states of its work groups");
    gl::StorageBuffer::clear(device_.bound(), bytesOfStates());
  }

  /// Counts the pushes, and waits for their number.
  void countPushes(KernelProgram& program) {
    bindStates();
    dispatch(program, task_, GroupStep::Count);
    dispatch(program, task_, GroupStep::Scan);
    for (const auto& list : lists_) {
      if (list->length >= 0) continue;
      list->length = readTotal(device_, list->total.planes.front());
      if (list->length > mostPushes) failForPushes(call_.kernel, call_.kernel.parameters[list->parameter]);
    }
  }

  void takePlanes(GroupList& list) {
    if (list.length == 0) return;
    if (list.isOfRecords) {
      const bool isKnown = hasRoomFor(list);
      list.records.emplace(device_, call_.kernel.parameters[list.parameter],
                           static_cast<std::int32_t>(list.length),
                           isKnown ? &list.total.planes.front() : nullptr);
      return;
    }
    list.planes.add(*call_.kernel.parameters[list.parameter].element, list.layout.texture,
                    "what a kernel pushes");
  }

  void findOwners() {
    if (std::ranges::all_of(targets_, [](const auto& target) { return target->firstOwner < 0; })) return;
    const Task task{.work = Work::Owners, .scattersInAnyOrder = task_.scattersInAnyOrder};
    KernelProgram& program =
        device_.programs().selected().kernelProgram(call_.kernel, operands_, layout_.whole, task);
    dispatch(program, task, GroupStep::All);
  }

  /// `outputs` is null if the step writes no images but those of totals.
  void dispatch(KernelProgram& program, const Task& task, GroupStep step, OutputTargets* outputs = nullptr) {
    const PassScope traced(device_, nameOf(call_.kernel.name, sk::stepOf(task), program), program, operands_,
                           std::span<const assemble::Rect>(layout_.draws), std::size_t{0});
    device_.bound().program(program.program.name());
    bindOperands(device_, program, call_.kernel, operands_);
    program.domain.set(device_.bound(), layout_.whole);
    program.rect.set(device_.bound(), {texelsInRow(), static_cast<std::int32_t>(texels()), rounds(),
                                       static_cast<std::int32_t>(step)});
    for (KernelProgram::Append& append : program.appends) setAppend(append);
    if (task.work == Work::Groups) bindImages(outputs);
    constexpr std::int64_t mostGroups = 65535;  // per dimension; guaranteed by GL 4.3
    const std::int64_t groups = step == GroupStep::Scan ? 1 : tiles();
    const std::int64_t inX = std::min(groups, mostGroups);
    device_.passes().dispatch(static_cast<GLsizei>(inX), static_cast<GLsizei>((groups + inX - 1) / inX),
                              Writes::Storage);
  }

  void setAppend(KernelProgram::Append& append) {
    for (const auto& list : lists_) {
      if (list->parameter != append.parameter) continue;
      append.layout.set(device_.bound(),
                        list->isOfRecords ? operands_[list->parameter].regionLayout : list->layout.whole);
      append.listShift.set(device_.bound(), list->layout.whole.shift);
      if (list->isOfRecords)
        append.owners.set(device_.bound(), {0, streamOf(list->parameter).layout.texture.width, 0, 0});
      append.room.set(device_.bound(), static_cast<std::int32_t>(std::max<std::int64_t>(list->length, 0)));
    }
    for (const auto& target : targets_) {
      if (target->parameter != append.parameter) continue;
      append.layout.set(device_.bound(), operands_[target->parameter].regionLayout);
      append.owners.set(device_.bound(),
                        {static_cast<std::int32_t>(std::max<std::int64_t>(target->firstOwner, 0)),
                         streamOf(target->parameter).layout.texture.width, 0, 0});
    }
  }

  /// Binds the images in the order of the program's outputs. Only totals if `outputs` is null.
  void bindImages(OutputTargets* outputs) {
    const std::vector<std::span<RenderTarget>> drawn =
        outputs != nullptr ? outputs->planesOfOutputs()
                           : std::vector<std::span<RenderTarget>>(operands_.size());
    int unit = 0;
    for (std::size_t i = 0; i < operands_.size(); ++i) {
      const Parameter& parameter = call_.kernel.parameters[i];
      const bool isWritten = parameter.role == Role::Output || assemble::isAppendOutput(parameter);
      if (!isWritten || !assemble::isNeeded(parameter, call_.specs)) continue;
      if (outputs != nullptr) bindPlanesOf(i, drawn[i], unit);
      unit += static_cast<int>(imagesOf(parameter));
    }
    for (const auto& list : lists_) bindImage(unit++, list->total.planes.front());
  }

  void bindPlanesOf(std::size_t i, std::span<RenderTarget> drawn, int unit) {
    const Parameter& parameter = call_.kernel.parameters[i];
    for (const auto& list : lists_) {
      if (list->parameter != i || !list->records) continue;
      for (const RenderTarget* plane : list->records->planes()) bindImage(unit++, *plane);
      return;
    }
    if (parameter.role == Role::Scatter) {
      for (const auto& target : targets_) {
        if (target->parameter == i)
          drawn = target->copy.planes.empty() ? streamOf(i).planes : target->copy.planes;
      }
      if (parameter.scatter != program::ScatterOp::Store && !drawn.empty()) {
        const bool isInt = parameter.element->fields.front().scalar == program::Scalar::Int;
        device_.bound().readWriteImage(unit, drawn.front().texture.name(), isInt ? GL_R32I : GL_R32UI);
        return;
      }
    } else if (parameter.role == Role::VariableOutput) {
      for (const auto& list : lists_) {
        if (list->parameter == i) drawn = list->planes.planes;
      }
    }
    for (RenderTarget& plane : drawn) bindImage(unit++, plane);
  }

  void bindImage(int unit, const RenderTarget& plane) {
    device_.bound().image(unit, plane.texture.name(), plane.texture.format().internalFormat);
  }

  void settleTarget(GroupTarget& target) noexcept {
    GlStream& stream = streamOf(target.parameter);
    if (!target.copy.planes.empty()) {
      std::swap(stream.planes, target.copy.planes);
      stream.labelPlanes();
    }
    stream.setWritten();
  }

  /// Whether the list has room for all that may come, so that only the device knows how many entries it has.
  bool hasRoomFor(const GroupList& list) const {
    return hasRoom(call_.kernel.parameters[list.parameter], call_.domain.size(), device_.limits.textureSize);
  }

  void combineRecords(GroupList& list) {
    if (!list.records) return;
    GlStream& stream = streamOf(list.parameter);
    StreamState* const written[] = {&stream};
    WriteScope writes(written);
    list.records->combine(stream);
    writes.commit();
  }

  void settleList(GroupList& list) noexcept {
    const bool isKnown = !hasRoomFor(list);
    streamOf(list.parameter)
        .replaceElements(list.planes.planes, std::move(list.layout),
                         isKnown ? nullptr : &list.total.planes.front());
    if (!isKnown) list.total.planes.clear();
  }

  GlDevice& device_;
  const ResolvedCall& call_;
  const std::vector<Operand> operands_;
  const Layout layout_;  ///< of the domain
  Task task_;
  std::vector<std::unique_ptr<GroupList>> lists_;
  std::vector<std::unique_ptr<GroupTarget>> targets_;
  std::int64_t words_ = 0;  ///< of the buffer of states
};

}  // namespace

bool dispatchAppends(GlDevice& device, const ResolvedCall& call) {
  unpackWritten(call);
  AppendDispatch dispatch(device, call);
  return dispatch.isPossible() && dispatch.run();
}

}  // namespace sk
