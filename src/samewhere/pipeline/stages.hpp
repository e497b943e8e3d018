#pragma once

#include <memory>

#include <samewhere/core/timing.hpp>
#include <samewhere/pipeline/full_bundles.hpp>
#include <samewhere/pipeline/loop_closing.hpp>
#include <samewhere/pipeline/mapping.hpp>

namespace samewhere::pipeline {

struct SlamTestHooks;  // slam_test_hooks.hpp

// Mapping, and loop closing and full bundle adjustment that it asks: with `threads` each in a
// thread of its own, else on the caller's.
class Stages {
 public:
  Stages(const Config& config, const SlamTestHooks& hooks);
  Stages(const Config& config, const scene::StoredMap& known, const SlamTestHooks& hooks);
  Stages(const Stages&) = delete;
  Stages& operator=(const Stages&) = delete;

  // What tracking sends to and receives from.
  MappingLink& link() { return *mapping_link_; }
  // Ends the stages when they have done all that was sent. Throws what a stage threw.
  void finish();

  const Mapping& mapping() const { return mapping_; }
  const LoopClosing& loop_closing() const { return loop_closing_; }
  // From here on: after finish().
  core::Timings timings() const;
  double processor_ms() const;

 private:
  // each stage ends before those that it asks
  LoopClosing loop_closing_;
  std::unique_ptr<LoopLink> loop_link_;
  Bundling bundling_;
  std::unique_ptr<BundleLink> bundle_link_;
  Mapping mapping_;
  std::unique_ptr<MappingLink> mapping_link_;
};

}  // namespace samewhere::pipeline
