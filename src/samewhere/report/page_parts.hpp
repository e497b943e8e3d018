#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <samewhere/core/ledger.hpp>
#include <samewhere/report/record.hpp>
#include <samewhere/report/upright.hpp>

// Parts of the data of the report page (page/README.md), also for a page that follows a run.

namespace samewhere::report {

// Seconds since the first stamp of a run, in steps.
class PageClock {
 public:
  explicit PageClock(double first_s) : first_s_(first_s) {}
  double first_s() const { return first_s_; }
  std::uint32_t steps(double stamp_s) const;

 private:
  double first_s_;
};

// As a text that may stand in a script element: `<` stands as \u003c. A name that is no UTF-8 does
// not cost the whole text.
std::string json_for_script(const nlohmann::ordered_json& json);

nlohmann::ordered_json page_stamps(const std::vector<std::uint32_t>& steps);
// `frames` of the page.
nlohmann::ordered_json page_frames(const std::vector<FrameRecord>& frames, const PageClock& clock);
nlohmann::ordered_json page_status_names();
nlohmann::ordered_json page_upright(const Upright& upright);
// An entry of `candidates`.
nlohmann::ordered_json page_candidate(const core::LedgerRow& row);
nlohmann::ordered_json page_checks(const core::Ledger& ledger);
nlohmann::ordered_json page_limits(const std::vector<ScoreLimit>& limits);

void add_position(std::vector<float>& positions, const std::optional<core::Rigid3>& pose);
// Nothing also if the pose is not finite.
std::optional<core::Rigid3> finite_pose(const FrameRecord& frame);

}  // namespace samewhere::report
