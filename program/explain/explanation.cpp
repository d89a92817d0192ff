#include "program/explain/explanation.hpp"

#include <algorithm>
#include <future>
#include <numeric>
#include <utility>

#include "program/compare/comparison.hpp"
#include "program/data/texels.hpp"
#include "program/execute/execution.hpp"
#include "program/explain/output_sites.hpp"
#include "program/lockstep/atomics.hpp"
#include "program/lockstep/ray_arbiter.hpp"
#include "program/record/contraction.hpp"
#include "rhi/error.hpp"

namespace tandem::program {
namespace {

bool runs_shaders(const Command& command) {
  return std::holds_alternative<Dispatch>(command) || std::holds_alternative<TraceRays>(command);
}

/// The launch on one device in all of its forms, each made once it is needed.
class Recorder {
 public:
  Recorder(rhi::Device& device, const Job& job, const Command& command, const Snapshot& inputs)
      : device_(device), job_(job), command_(command), inputs_(inputs) {}

  RecordedExecution& of(RecordForm form, bool mirrored = false) {
    Form& made = forms_[mirrored ? 3 : static_cast<std::size_t>(form)];
    if (made.execution == nullptr) {
      made.launch = std::make_unique<RecordedLaunch>(record_launch(job_, command_, form, mirrored));
      made.execution = std::make_unique<RecordedExecution>(device_, *made.launch, inputs_);
    }
    return *made.execution;
  }

  std::unique_ptr<RecordedLaunch> take_launch(RecordForm form) {
    Form& made = forms_[static_cast<std::size_t>(form)];
    made.execution.reset();
    return std::move(made.launch);
  }

 private:
  struct Form {
    std::unique_ptr<RecordedLaunch> launch;
    std::unique_ptr<RecordedExecution> execution;
  };

  rhi::Device& device_;
  const Job& job_;
  const Command& command_;
  const Snapshot& inputs_;
  std::array<Form, 4> forms_;  ///< by RecordForm; the last is the mirrored lockstep
};

/// At most `most` of the values, evenly spread.
std::vector<std::uint64_t> spread(const std::vector<std::uint64_t>& values, std::uint64_t most) {
  if (values.size() <= most) return values;
  std::vector<std::uint64_t> chosen;
  for (std::uint64_t i = 0; i < most; ++i) chosen.push_back(values[i * values.size() / most]);
  return chosen;
}

/// The invocations to record: the one that was asked for, all that fit, or those whose hashes differ.
class Selection {
 public:
  Selection(Recorder& a, Recorder& b, const ExplainOptions& options) : a_(a), b_(b), options_(options) {}

  std::vector<std::uint64_t> invocations;
  std::uint64_t launched = 0;
  std::optional<std::uint64_t> other_bits;

  void select(const std::array<std::uint32_t, 3>& size) {
    launched = std::uint64_t{size[0]} * size[1] * size[2];
    if (options_.invocation) {
      const auto& id = *options_.invocation;
      for (std::size_t axis = 0; axis < 3; ++axis)
        if (id[axis] >= size[axis])
          throw rhi::Error(rhi::ErrorCode::invalid_argument, "",
                           "there is no invocation " + std::to_string(id[0]) + "," + std::to_string(id[1]) + "," +
                               std::to_string(id[2]) + "; the launch has " + std::to_string(size[0]) + " x " +
                               std::to_string(size[1]) + " x " + std::to_string(size[2]));
      invocations = {id[0] + size[0] * (id[1] + std::uint64_t{size[1]} * id[2])};
      return;
    }
    if (launched > options_.most_invocations || !fits(launched)) return by_hash();
    invocations.resize(launched);
    std::iota(invocations.begin(), invocations.end(), std::uint64_t{0});
  }

 private:
  bool fits(std::uint64_t count) {
    std::vector<std::uint64_t> all(count);
    std::iota(all.begin(), all.end(), std::uint64_t{0});
    const std::uint64_t words = a_.of(RecordForm::record).needed_words(std::move(all));
    return words * count * sizeof(std::uint32_t) * 2 <= options_.most_bytes;
  }

  void by_hash() {
    const std::vector<std::uint32_t> of_a = a_.of(RecordForm::hash).hashes(), of_b = b_.of(RecordForm::hash).hashes();
    std::vector<std::uint64_t> differing;
    for (std::uint64_t i = 0; i < launched; ++i)
      if (of_a[i] != of_b[i]) differing.push_back(i);
    other_bits = differing.size();
    if (differing.empty()) return;
    const std::uint64_t words = a_.of(RecordForm::record).needed_words(spread(differing, options_.most_invocations));
    const std::uint64_t fitting = options_.most_bytes / (words * sizeof(std::uint32_t) * 2);
    invocations = spread(differing, std::clamp<std::uint64_t>(fitting, 1, options_.most_invocations));
  }

  Recorder& a_;
  Recorder& b_;
  const ExplainOptions& options_;
};

/// Whether the values are the same by their type: which pattern of bits a NaN has, Vulkan leaves open.
bool holds_same(const Job& job, bool is_image, std::size_t index, const std::vector<std::byte>& a,
                const std::vector<std::byte>& b) {
  if (a == b) return true;
  const ValueType type = is_image ? texture_type(job.images[index].desc) : job.buffers[index].type;
  return scalar_count(type, a.size()) != 0 && compare(type, a, b, {}).agrees();
}

std::vector<OutputState> compare_outputs(const Job& job, const Snapshot& inputs, const Snapshot& plain_a,
                                         const Snapshot& plain_b, const Snapshot& recorded_a, const Snapshot& free_b,
                                         const Snapshot& forced_b, const Snapshot& mirrored_a) {
  std::vector<OutputState> outputs;
  const auto add = [&](bool is_image, auto member) {
    const auto& before = inputs.*member;
    for (std::size_t i = 0; i < before.size(); ++i) {
      const auto &of_a = (plain_a.*member)[i], &of_b = (plain_b.*member)[i];
      if (of_a == before[i] && of_b == before[i]) continue;
      outputs.push_back({.is_image = is_image,
                         .index = i,
                         .plain_equal = of_a == of_b,
                         .forced_equal = holds_same(job, is_image, i, (recorded_a.*member)[i], (forced_b.*member)[i]),
                         .record_changed_a = of_a != (recorded_a.*member)[i],
                         .record_changed_b = of_b != (free_b.*member)[i],
                         .order_changed = (recorded_a.*member)[i] != (mirrored_a.*member)[i]});
    }
  };
  add(false, &Snapshot::buffers);
  add(true, &Snapshot::images);
  return outputs;
}

/// The slot with the gravest difference; the first where none differs.
std::size_t most_interesting(const Explanation& explanation) {
  if (!explanation.lockstep.sites.empty()) return explanation.lockstep.sites.front().example.slot;
  const auto first =
      std::ranges::find_if(explanation.first, [](const FirstDivergence& each) { return each.value.has_value(); });
  return first == explanation.first.end() ? 0 : static_cast<std::size_t>(first - explanation.first.begin());
}

/// A launch that begins behind the first workgroup is not mirrored: the shader does not know where it begins.
bool can_be_mirrored(const Command& command) {
  const auto* dispatch = std::get_if<Dispatch>(&command);
  return dispatch == nullptr || dispatch->base_workgroup == std::array<std::uint32_t, 3>{};
}

bool is_open(const Judgement& judgement) {
  return judgement.cause == Cause::mismatch && judgement.wrong == WrongDevice::unknown;
}

/// Whether something differs that the order of invocations may explain. A race may come out alike in lockstep, and
/// differ where device b runs free.
bool is_open(const Explanation& explanation, const Snapshot& recorded_a, const Snapshot& forced_b) {
  const auto is_open_difference = [](const std::optional<Divergence>& each) {
    return each && is_open(each->judgement);
  };
  return recorded_a.buffers != forced_b.buffers || recorded_a.images != forced_b.images ||
         std::ranges::any_of(explanation.lockstep.sites,
                             [](const Site& site) { return is_open(site.example.judgement); }) ||
         std::ranges::any_of(explanation.first, [&](const FirstDivergence& first) {
           return is_open_difference(first.value) || is_open_difference(first.decision);
         });
}

/// Whether what is wrong may be right where the first device combines it with other instructions.
bool may_be_combined(const Explanation& explanation) {
  const auto is_wrong_arithmetic = [](const Divergence& each) {
    return each.judgement.cause == Cause::mismatch &&
           may_be_contracted(each.shader->module, each.shader->module.instructions[each.instruction]);
  };
  return std::ranges::any_of(explanation.lockstep.sites,
                             [&](const Site& site) { return is_wrong_arithmetic(site.example); }) ||
         std::ranges::any_of(explanation.first, [&](const FirstDivergence& first) {
           return (first.value && is_wrong_arithmetic(*first.value)) ||
                  (first.decision && is_wrong_arithmetic(*first.decision));
         });
}

/// Judges what the recordings differ in.
void compare(Explanation& result, const Circumstances& circumstances) {
  result.lockstep = compare_lockstep(*result.launch, result.a, result.forced, circumstances);
  result.first.clear();
  for (std::size_t slot = 0; slot < result.a.request.invocations.size(); ++slot)
    result.first.push_back(first_divergence(*result.launch, result.a, result.free, slot, circumstances));
}

/// Adds what is to blame for memory that differs although all values agree.
void add_output_sites(Explanation& result, const Snapshot& recorded_a, const Snapshot& forced_b) {
  // Where memory depends on the order of invocations, it says nothing.
  std::vector<char> ignored(recorded_a.buffers.size(), 0);
  for (const OutputState& output : result.outputs)
    if (!output.is_image && (output.order_changed || output.forced_equal)) ignored[output.index] = 1;
  for (Site& site : output_sites(*result.launch, result.a, recorded_a, forced_b, ignored)) {
    std::vector<Site>& sites = result.lockstep.sites;
    const bool is_known = std::ranges::any_of(sites, [&](const Site& known) {
      return known.shader == site.shader && known.instruction == site.instruction &&
             known.example.judgement.cause == Cause::mismatch;
    });
    if (!is_known) sites.insert(sites.begin(), std::move(site));
  }
}

Explanation explain_command(rhi::Device& a, rhi::Device& b, const Job& job, const Command& command,
                            const Snapshot& inputs, const ExplainOptions& options) {
  Explanation result;
  Recorder on_a(a, job, command, inputs), on_b(b, job, command, inputs);
  // Both devices compile at once; without an invocation it is not known yet whether b is to record.
  std::future<void> form_of_b;
  if (options.invocation && &a != &b)
    form_of_b = std::async(std::launch::async, [&] { on_b.of(RecordForm::lockstep); });
  // Only the launch knows its size: that of a workgroup is the shader's.
  on_a.of(RecordForm::record);
  if (form_of_b.valid()) form_of_b.get();
  Selection selection(on_a, on_b, options);
  selection.select(on_a.of(RecordForm::record).launch().size);
  result.launched = selection.launched;
  result.other_bits = selection.other_bits;
  result.all_recorded = selection.invocations.size() == selection.launched;
  if (selection.invocations.empty()) {
    result.launch = on_a.take_launch(RecordForm::record);
    return result;
  }
  result.a = on_a.of(RecordForm::record).record(selection.invocations, options.most_bytes);
  const Snapshot recorded_a = on_a.of(RecordForm::record).outputs();
  RecordedExecution& replayer = on_b.of(RecordForm::lockstep);
  result.free = replayer.replay(result.a, false);
  const Snapshot free_b = replayer.outputs();
  result.forced = replayer.replay(result.a, true);
  const Snapshot forced_b = replayer.outputs();
  result.launch = on_a.take_launch(RecordForm::record);

  Circumstances circumstances;
  circumstances.subgroup_size = a.info().limits.subgroup_size;
  circumstances.same_subgroups = a.info().limits.subgroup_size == b.info().limits.subgroup_size;
  std::optional<RayArbiter> rays;
  if (options.exact != nullptr && !job.top_levels.empty()) {
    rays.emplace(*options.exact, result.launch->job);
    circumstances.rays = &*rays;
  }
  compare(result, circumstances);
  std::optional<Recording> alone_a;
  if (may_be_combined(result)) {
    alone_a = on_a.of(RecordForm::lockstep).replay(result.a, true);
    circumstances.alone_a = &*alone_a;
    compare(result, circumstances);
  }
  Snapshot mirrored_a = recorded_a;
  if (options.check_order && can_be_mirrored(command) && is_open(result, recorded_a, forced_b)) {
    RecordedExecution& mirror = on_a.of(RecordForm::lockstep, true);
    const Recording mirrored = mirror.replay(result.a, true);
    circumstances.order_dependent = differing_sites(*result.launch, result.a, mirrored);
    if (result.all_recorded) {
      AtomicFindings atomics = judge_atomics(*result.launch, result.a, result.forced);
      circumstances.wrong_atomics = std::move(atomics.wrong);
      circumstances.order_dependent.merge(atomics.contended);
    }
    mirrored_a = mirror.outputs();
    compare(result, circumstances);
  }

  Job single = job;
  single.commands = {command};
  const auto plain = [&](rhi::Device& device) {
    Execution execution(device, single);
    restore(execution, inputs);
    execution.run();
    return snapshot_of(execution, single);
  };
  result.outputs = compare_outputs(job, inputs, plain(a), plain(b), recorded_a, free_b, forced_b, mirrored_a);
  if (result.all_recorded) {
    add_output_sites(result, recorded_a, forced_b);
  } else {
    for (OutputState& output : result.outputs) output.forced_equal = true;
  }
  result.slot = most_interesting(result);
  return result;
}

bool differs(const Explanation& explanation) {
  return !explanation.lockstep.sites.empty() || explanation.lockstep.parted != 0 ||
         std::ranges::any_of(explanation.first, [](const FirstDivergence& each) { return each.value.has_value(); }) ||
         std::ranges::any_of(explanation.outputs, [](const OutputState& each) { return !each.plain_equal; });
}

}  // namespace

Explanation explain(rhi::Device& a, rhi::Device& b, const Job& job, const ExplainOptions& options) {
  if (options.command && (*options.command >= job.commands.size() || !runs_shaders(job.commands[*options.command])))
    throw rhi::Error(rhi::ErrorCode::invalid_argument, "",
                     "command " + std::to_string(*options.command + 1) + " runs no shaders");
  Execution before(a, job);
  Explanation last;
  for (std::size_t i = 0; i < job.commands.size(); ++i) {
    const Command& command = job.commands[i];
    if (runs_shaders(command) && (!options.command || *options.command == i)) {
      last = explain_command(a, b, job, command, snapshot_of(before, job), options);
      last.command = i;
      if (options.command || differs(last)) return last;
    }
    before.run(command);
  }
  return last;
}

Cause gravest(const Explanation& explanation) {
  Cause cause = Cause::equal;
  if (!explanation.lockstep.sites.empty()) cause = explanation.lockstep.sites.front().example.judgement.cause;
  for (const OutputState& output : explanation.outputs)
    if (!output.forced_equal && !output.order_changed) cause = Cause::mismatch;
  return cause;
}

}  // namespace tandem::program
