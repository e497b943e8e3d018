#include <algorithm>
#include <cmath>

#include <samewhere/report/funnel.hpp>
#include <samewhere/report/loops.hpp>
#include <samewhere/report/packed.hpp>
#include <samewhere/report/page_parts.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStampStep_s = 1e-4;

Json numbers(const Eigen::Vector3d& vector) { return {vector.x(), vector.y(), vector.z()}; }

void add_rotation(std::vector<std::int16_t>& rotations, const std::optional<core::Rigid3>& pose) {
  constexpr double kLargest = 32767.0;
  const Eigen::Quaterniond q = pose ? pose->rotation : Eigen::Quaterniond::Identity();
  for (const double value : {q.x(), q.y(), q.z(), q.w()})
    rotations.push_back(
        static_cast<std::int16_t>(std::lround(kLargest * std::clamp(value, -1.0, 1.0))));
}

}  // namespace

std::uint32_t PageClock::steps(double stamp_s) const {
  const double steps = std::round((stamp_s - first_s_) / kStampStep_s);
  return static_cast<std::uint32_t>(std::clamp(steps, 0.0, 4e9));
}

std::string json_for_script(const Json& json) {
  const std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  std::string safe;
  safe.reserve(text.size());
  for (const char c : text) c == '<' ? safe.append("\\u003c") : safe.append(1, c);
  return safe;
}

Json page_stamps(const std::vector<std::uint32_t>& steps) {
  Json array = packed(steps);
  array["step"] = {kStampStep_s};
  return array;
}

void add_position(std::vector<float>& positions, const std::optional<core::Rigid3>& pose) {
  for (int axis = 0; axis < 3; ++axis)
    positions.push_back(pose ? static_cast<float>(pose->translation[axis]) : std::nanf(""));
}

std::optional<core::Rigid3> finite_pose(const FrameRecord& frame) {
  const auto& pose = frame.world_from_camera;
  return pose && core::is_finite(*pose) ? pose : std::nullopt;
}

Json page_frames(const std::vector<FrameRecord>& records, const PageClock& clock) {
  std::vector<std::uint32_t> indices;
  std::vector<std::uint32_t> stamps;
  std::vector<float> positions;
  std::vector<std::int16_t> rotations;
  std::vector<std::uint8_t> statuses;
  std::vector<std::uint16_t> inliers;
  Json names = Json::array();
  for (const FrameRecord& frame : records) {
    indices.push_back(static_cast<std::uint32_t>(frame.pose.frame.index()));
    stamps.push_back(clock.steps(frame.pose.stamp_s));
    add_position(positions, finite_pose(frame));
    add_rotation(rotations, finite_pose(frame));
    statuses.push_back(static_cast<std::uint8_t>(frame.pose.status));
    inliers.push_back(static_cast<std::uint16_t>(std::clamp(frame.pose.num_inliers, 0, 65535)));
    names.push_back(frame.name);
  }
  Json packed_rotations = packed(rotations, 4);
  packed_rotations["step"] = {1.0 / 32767.0};
  const auto session = records.empty() ? std::uint16_t{0} : records.front().pose.frame.session();
  return {{"num", records.size()},
          {"session", session},
          {"first_stamp_s", clock.first_s()},
          {"indices", packed(indices)},
          {"stamps_s", page_stamps(stamps)},
          {"positions", packed(positions, 3)},
          {"rotations", std::move(packed_rotations)},
          {"statuses", packed(statuses)},
          {"inliers", packed(inliers)},
          {"names", std::move(names)}};
}

Json page_status_names() {
  Json names = Json::array();
  for (int i = 0; i <= static_cast<int>(core::kLastStatus); ++i)
    names.push_back(core::name_of(static_cast<core::FrameStatus>(i)));
  return names;
}

Json page_upright(const Upright& upright) {
  return {{"up", numbers(upright.up)}, {"right", numbers(upright.right)}};
}

Json page_candidate(const core::LedgerRow& row) {
  Json entry = Json::parse(ledger_row_json(row));
  entry["id"] = row.candidate.id.index();
  return entry;
}

Json page_checks(const core::Ledger& ledger) {
  Json checks = Json::array();
  for (const FunnelRow& row : funnel(ledger).rows)
    checks.push_back({{"name", core::name_of(row.stage)},
                      {"question", question_of(row.stage)},
                      {"num_arrived", row.num_arrived},
                      {"num_rejected", row.num_rejected},
                      {"num_ambiguous", row.num_ambiguous}});
  return checks;
}

Json page_limits(const std::vector<ScoreLimit>& limits) {
  Json array = Json::array();
  for (const ScoreLimit& limit : limits) {
    Json entry = {{"score", limit.score},
                  {"setting", limit.setting},
                  {"is_minimum", limit.is_minimum},
                  {"value", limit.value}};
    if (!limit.share_of.empty()) entry["share_of"] = limit.share_of;
    array.push_back(std::move(entry));
  }
  return array;
}

}  // namespace samewhere::report
