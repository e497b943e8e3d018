#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/loops_read.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;  // as in loops.cpp

// Frames and candidates are counted by int. A negative number reads as a large one.
std::uint64_t index_of(const Json& json) {
  const auto index = json.get<std::uint64_t>();
  if (index <= static_cast<std::uint64_t>(std::numeric_limits<int>::max())) return index;
  throw core::InputError(
      fmt::format("found {}, expected the number of a frame or candidate", json.dump()));
}

// One entry of the file. What is wrong with it comes out as a Json exception.
class Entry {
 public:
  Entry(const Json& json, std::size_t position) : json_(json), scores_(json.at("scores")) {
    row_.candidate = {core::CandidateId(position),
                      frame("query"),
                      frame("match"),
                      scores_.at("similarity").get<double>(),
                      json.value("is_foretold", false),
                      json.value("is_lost", false),
                      json.value("is_by_features", false)};
  }

  core::LedgerRow row() && {
    const auto verdict = json_.at("verdict").get<std::string>();
    const auto reason = json_.at("reason").get<std::string>();
    const core::Evidence evidence = this->evidence();
    if (verdict == "LOOP") {
      core::LoopClosure loop{.candidate = row_.candidate.id, .evidence = evidence};
      loop.match_from_query = pose();
      loop.scale_is_free = scores_.contains("scale");
      loop.is_by_hand = json_.value("is_by_hand", false);
      if (json_.contains("overruled")) loop.overruled = candidate(json_.at("overruled"));
      row_.verdict = loop;
    } else if (verdict == "AMBIGUOUS") {
      row_.verdict = core::Ambiguous{row_.candidate.id, evidence, stage(), reason};
    } else {
      row_.verdict = core::Rejection{row_.candidate.id, evidence, stage(), reason};
    }
    return std::move(row_);
  }

 private:
  core::FrameId frame(const char* name) const {
    return core::FrameId(index_of(json_.at(name)),
                         json_.value(std::string(name) + "_session", std::uint16_t{0}));
  }

  // Of this query's session.
  core::CandidateId candidate(const Json& index) const {
    return core::CandidateId(index_of(index), row_.candidate.query.session());
  }

  std::optional<double> score(const char* name) const {
    const auto found = scores_.find(name);
    if (found == scores_.end() || found->is_null()) return std::nullopt;
    return found->get<double>();
  }

  core::Refusal stage() const {
    const auto name = json_.at("stage").get<std::string>();
    const auto found =
        std::find_if(std::begin(core::kAllRefusals), std::end(core::kAllRefusals),
                     [&](core::Refusal refusal) { return core::name_of(refusal) == name; });
    if (found == std::end(core::kAllRefusals))
      throw core::InputError(
          fmt::format("\"stage\" is \"{}\"; expected the name of a check", name));
    return *found;
  }

  std::optional<core::Sim3> pose() const {
    const Json& numbers = json_.at("match_from_query");
    if (numbers.is_null()) return std::nullopt;
    const auto at = [&](std::size_t i) { return numbers.at(i).get<double>(); };
    return core::Sim3{score("scale").value_or(1.0),
                      Eigen::Quaterniond(at(6), at(3), at(4), at(5)),
                      {at(0), at(1), at(2)}};
  }

  core::Evidence evidence() const {
    core::Evidence evidence{.similarity = row_.candidate.similarity};
    if (score("num_matches")) evidence.geometry = geometry();
    if (const auto squared = score("mahalanobis_squared"))
      evidence.odometry = {score("correction_m").value_or(0.0),
                           score("correction_rad").value_or(0.0), *squared};
    if (scores_.contains("rival")) evidence.rival = rival();
    if (scores_.contains("other_place"))
      evidence.other_place = {.frame = core::FrameId(index_of(scores_.at("other_place"))),
                              .num_inliers = scores_.at("other_place_inliers").get<int>(),
                              .apart_m = score("other_place_apart_m").value_or(0.0),
                              .apart_rad = score("other_place_apart_rad").value_or(0.0)};
    if (scores_.contains("query_view")) evidence.sequence = sequence();
    return evidence;
  }

  core::RivalEvidence rival() const {
    core::RivalEvidence rival{
        .frame = core::FrameId(index_of(scores_.at("rival"))),
        .apart_m = score("rival_apart_m").value_or(0.0),
        .apart_rad = score("rival_apart_rad").value_or(0.0),
        .mahalanobis_squared = score("rival_mahalanobis_squared").value_or(0.0),
        .gain = score("rival_gain")};
    if (scores_.contains("rival_first_loop"))
      rival.first_loop = candidate(scores_.at("rival_first_loop"));
    return rival;
  }

  core::SequenceEvidence sequence() const {
    return {.query_view = scores_.at("query_view").get<int>(),
            .match_view = scores_.at("match_view").get<int>(),
            .num_views = scores_.at("num_sequence_views").get<int>(),
            .num_inliers = scores_.at("num_sequence_inliers").get<int>(),
            .is_over = json_.at("verdict") != "AMBIGUOUS"};
  }

  core::GeometryEvidence geometry() const {
    core::GeometryEvidence geometry;
    geometry.num_matches = scores_.at("num_matches").get<int>();
    if (score("num_first_matches")) {
      geometry.num_guided_matches = geometry.num_matches;
      geometry.num_matches = scores_.at("num_first_matches").get<int>();
    }
    geometry.num_inliers = score("num_inliers") ? scores_.at("num_inliers").get<int>() : 0;
    geometry.inlier_ratio = score("inlier_ratio").value_or(0.0);
    geometry.spread_ratio = score("spread_ratio").value_or(0.0);
    geometry.overlap_ratio = score("overlap_ratio").value_or(0.0);
    geometry.reprojection_rmse_px = score("reprojection_rmse_px").value_or(0.0);
    geometry.match_from_query = pose();
    geometry.disagreement_m = score("disagreement_m");
    geometry.disagreement_rad = score("disagreement_rad");
    // a number without end is left out of the file
    if (!geometry.disagreement_m && json_.at("stage") == "agreement")
      geometry.disagreement_m = std::numeric_limits<double>::infinity();
    return geometry;
  }

  const Json& json_;
  const Json& scores_;
  core::LedgerRow row_;
};

}  // namespace

core::Ledger read_loops_json(const std::filesystem::path& path) {
  const std::string text = core::read_file(path);
  std::string where;
  try {
    const Json document = Json::parse(text);
    const int version = document.at("version").get<int>();
    if (version != 1) throw core::InputError(fmt::format("version {}; expected 1", version));
    core::Ledger ledger;
    for (const Json& json : document.at("candidates")) {
      where = fmt::format("candidate {}: ", ledger.size());
      ledger.push_back(Entry(json, ledger.size()).row());
    }
    return ledger;
  } catch (const Json::exception& error) {
    throw core::InputError(fmt::format("{}: {}expected what `samewhere run` writes, but {}",
                                       path.string(), where, error.what()));
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}{}", path.string(), where, error.what()));
  }
}

core::Ledger read_ledger_rows(const std::vector<std::string>& rows, const std::string& name) {
  core::Ledger ledger;
  for (const std::string& row : rows) {
    const auto refuse = [&](const char* why) {
      throw core::InputError(
          fmt::format("{}: row {} of its ledger: expected what `samewhere run` "
                      "writes, but {}",
                      name, ledger.size(), why));
    };
    try {
      const Json json = Json::parse(row);
      ledger.push_back(Entry(json, ledger.size()).row());
    } catch (const Json::exception& error) {
      refuse(error.what());
    } catch (const core::InputError& error) {
      refuse(error.what());
    }
  }
  return ledger;
}

}  // namespace samewhere::report
