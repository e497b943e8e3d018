#include <utility>

#include <samewhere/core/background.hpp>
#include <samewhere/pipeline/slam_test_hooks.hpp>
#include <samewhere/pipeline/stages.hpp>

namespace samewhere::pipeline {
namespace {

template <class Message, class Answer>
std::unique_ptr<core::Link<Message, Answer>> link_to(
    typename core::Link<Message, Answer>::Serve stage, bool in_thread, int capacity,
    core::StageHook before_message) {
  if (!in_thread) return std::make_unique<core::DirectLink<Message, Answer>>(std::move(stage));
  return std::make_unique<core::ThreadLink<Message, Answer>>(
      std::move(stage), static_cast<std::size_t>(capacity), std::move(before_message));
}

// Mapping asks about a keyframe before it receives the answer to the one `lag` before it.
std::unique_ptr<LoopLink> link_to(LoopClosing& stage, const Config& config,
                                  const SlamTestHooks& hooks) {
  return link_to<ToLoopClosing, LoopAnswer>(
      [&stage, alter = hooks.alter_loops](const ToLoopClosing& message,
                                          const LoopLink::Reply& reply) {
        LoopAnswer answer = stage.answer(message);
        if (alter) alter(message, answer);
        reply(std::move(answer));
      },
      config.threads, config.map.loop_lag_keyframes, hooks.before_message);
}

// One full bundle adjustment is in progress at most. It takes seconds, at low priority.
std::unique_ptr<BundleLink> link_to(Bundling& stage, const Config& config,
                                    const SlamTestHooks& hooks) {
  return link_to<BundleAll, scene::Edit>(
      [&stage, in_thread = config.threads](const BundleAll& message,
                                           const BundleLink::Reply& reply) {
        if (in_thread) core::work_in_background();
        reply(stage.answer(message));
      },
      config.threads, 1, hooks.before_message);
}

// One keyframe is in progress at most; what tracking sends beside it need not wait for room.
constexpr int kMappingCapacity = 4;

std::unique_ptr<MappingLink> link_to(Mapping& stage, const Config& config,
                                     const SlamTestHooks& hooks) {
  return link_to<ToMapping, MapAnswer>(
      [&stage](const ToMapping& message, const MappingLink::Reply& reply) {
        stage.take(message, reply);
      },
      config.threads, kMappingCapacity, hooks.before_message);
}

}  // namespace

Stages::Stages(const Config& config, const SlamTestHooks& hooks)
    : loop_closing_(config),
      loop_link_(link_to(loop_closing_, config, hooks)),
      bundling_(config),
      bundle_link_(link_to(bundling_, config, hooks)),
      mapping_(config, {}, {*loop_link_, *bundle_link_}, hooks.keep_map),
      mapping_link_(link_to(mapping_, config, hooks)) {}

Stages::Stages(const Config& config, const scene::StoredMap& known, const SlamTestHooks& hooks)
    : loop_closing_(config, known),
      loop_link_(link_to(loop_closing_, config, hooks)),
      bundling_(config),
      bundle_link_(link_to(bundling_, config, hooks)),
      mapping_(config, known.map, {*loop_link_, *bundle_link_}, hooks.keep_map),
      mapping_link_(link_to(mapping_, config, hooks)) {}

void Stages::finish() {
  mapping_link_->finish();
  loop_link_->finish();
  bundle_link_->finish();
}

core::Timings Stages::timings() const {
  core::Timings timings = mapping_.timings();
  timings.add(loop_closing_.timings());
  timings.add(bundling_.timings());
  return timings;
}

double Stages::processor_ms() const {
  return mapping_link_->processor_ms() + loop_link_->processor_ms() + bundle_link_->processor_ms();
}

}  // namespace samewhere::pipeline
