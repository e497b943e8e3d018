#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/file.hpp>
#include <samewhere/report/loops.hpp>
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

// One entry of the file. Throws a Json exception on a malformed one.
class Entry {
 public:
  Entry(const Json& json, std::size_t position) : json_(json), scores_(json.at("scores")) {
    row_.candidate = {core::CandidateId(position), frame("query"), frame("match"),
                      scores_.at("similarity").get<double>(), origin()};
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
  core::Origin origin() const {
    if (!json_.contains("origin")) return origin_of_version_1();
    const auto name = json_.at("origin").get<std::string>();
    const auto found =
        std::find_if(std::begin(core::kAllOrigins), std::end(core::kAllOrigins),
                     [&](core::Origin origin) { return core::name_of(origin) == name; });
    if (found == std::end(core::kAllOrigins))
      throw core::InputError(
          fmt::format("\"origin\" is \"{}\"; expected \"retrieved\", \"visual "
                      "words\", \"neighbour\", \"predicted\" or "
                      "\"relocalization\"",
                      name));
    return *found;
  }

  // Predicted pairs and neighbours had one flag.
  core::Origin origin_of_version_1() const {
    if (json_.value("is_lost", false)) return core::Origin::kRelocalization;
    if (json_.value("is_foretold", false)) return core::Origin::kPredicted;
    return json_.value("is_by_features", false) ? core::Origin::kVisualWords
                                                : core::Origin::kRetrieved;
  }

  core::FrameId frame(const char* name) const {
    return core::FrameId(index_of(json_.at(name)),
                         json_.value(std::string(name) + "_session", std::uint16_t{0}));
  }

  // Of this query's session.
  core::CandidateId candidate(const Json& index) const {
    return core::CandidateId(index_of(index), row_.candidate.query.session());
  }

  // The name of a score in the file, where version 1 had another.
  const char* known(const char* name, const char* name_in_version_1) const {
    return scores_.contains(name) ? name : name_in_version_1;
  }

  std::optional<double> score(const std::string& name) const {
    const auto found = scores_.find(name);
    if (found == scores_.end() || found->is_null()) return std::nullopt;
    return found->get<double>();
  }

  std::string stage_name() const {
    auto name = json_.at("stage").get<std::string>();
    if (name == "agreement") return "consistency";  // in version 1
    if (name == "rival") return "competing";
    return name;
  }

  core::Refusal stage() const {
    const std::string name = stage_name();
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
                           score("correction_rad").value_or(0.0),
                           *squared,
                           score("odometry_sigma_m"),
                           score("look_alike_gain"),
                           score("look_alike_gain_with_loops"),
                           score("mahalanobis_squared_with_loops"),
                           score("variance_factor")};
    if (const auto rmse_m = score("deformation_rmse_m"))
      evidence.deformation = {*rmse_m, score("deformation_path_m").value_or(0.0)};
    if (scores_.contains("competing_loop"))
      evidence.competing_loop = competing_loop("competing_loop", "competing_loop_first");
    else if (scores_.contains("rival"))
      evidence.competing_loop = competing_loop("rival", "rival_first_loop");
    if (scores_.contains("competing_place"))
      evidence.competing_place = competing_place("competing_place");
    else if (scores_.contains("other_place"))
      evidence.competing_place = competing_place("other_place");
    if (scores_.contains("query_view")) evidence.sequence = sequence();
    return evidence;
  }

  core::CompetingLoopEvidence competing_loop(const std::string& name,
                                             const std::string& first_loop) const {
    core::CompetingLoopEvidence loop{
        .frame = core::FrameId(index_of(scores_.at(name))),
        .apart_m = score(name + "_apart_m").value_or(0.0),
        .apart_rad = score(name + "_apart_rad").value_or(0.0),
        .mahalanobis_squared = score(name + "_mahalanobis_squared").value_or(0.0),
        .gain = score(name + "_gain")};
    if (scores_.contains(first_loop)) loop.first_loop = candidate(scores_.at(first_loop));
    return loop;
  }

  core::CompetingPlaceEvidence competing_place(const std::string& name) const {
    return {.frame = core::FrameId(index_of(scores_.at(name))),
            .num_inliers = scores_.at(name + "_inliers").get<int>(),
            .apart_m = score(name + "_apart_m").value_or(0.0),
            .apart_rad = score(name + "_apart_rad").value_or(0.0)};
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
    geometry.pose_difference_m = score(known("pose_difference_m", "disagreement_m"));
    geometry.pose_difference_rad = score(known("pose_difference_rad", "disagreement_rad"));
    // a number without end is left out of the file
    if (!geometry.pose_difference_m && stage_name() == "consistency")
      geometry.pose_difference_m = std::numeric_limits<double>::infinity();
    return geometry;
  }

  const Json& json_;
  const Json& scores_;
  core::LedgerRow row_;
};

// Counts what is in one entry while it is parsed. Ours have some 40 values; a value takes up to 100
// bytes of memory for three of the file.
class EntrySize {
 public:
  void begin() { num_values_ = 0; }
  void count() {
    constexpr int kMax = 1000;
    if (++num_values_ > kMax)
      throw core::InputError(fmt::format("has more than {} values, expected a candidate", kMax));
  }

 private:
  int num_values_ = 0;
};

// Reads loops.json entry by entry: the document is never in memory as a whole, nor are foreign
// keys.
class Document {
 public:
  core::Ledger read(const std::string& text) && {
    const Json::parser_callback_t visit = [this](int depth, Event event, const Json& json) {
      return this->visit(depth, event, json);
    };
    const Json rest = Json::parse(text, visit);
    is_parsed_ = true;
    const int version = rest.at("version").get<int>();
    if (version != 1 && version != kLoopsVersion)
      throw core::InputError(fmt::format("version {}; expected 1 or {}", version, kLoopsVersion));
    rest.at("candidates");
    return std::move(ledger_);
  }

  // The entry that it stands at: "candidate 7: ".
  std::string where() const {
    return is_in_list_ && !is_parsed_ ? fmt::format("candidate {}: ", ledger_.size()) : "";
  }

 private:
  using Event = Json::parse_event_t;
  static constexpr int kKeyDepth = 1;
  static constexpr int kEntryDepth = 2;

  // Whether the value is kept.
  bool visit(int depth, Event event, const Json& json) {
    if (depth == kKeyDepth && event == Event::key) {
      key_ = json.get<std::string>();
      return key_ == "version" || key_ == "candidates";
    }
    if (depth == kKeyDepth && key_ == "candidates") visit_list(event);
    if (!is_in_list_) return depth == 0 || event == Event::value || key_ == "candidates";
    if (depth >= kEntryDepth) return visit_entry(depth, event, json);
    return true;
  }

  void visit_list(Event event) {
    if (event != Event::array_start && event != Event::array_end)
      throw core::InputError("\"candidates\" is no list");
    is_in_list_ = event == Event::array_start;
  }

  bool visit_entry(int depth, Event event, const Json& json) {
    if (depth > kEntryDepth) {
      size_.count();
      return true;
    }
    if (event == Event::object_start) {
      size_.begin();
      return true;
    }
    if (event != Event::object_end) throw core::InputError("is no object");
    ledger_.push_back(Entry(json, ledger_.size()).row());
    return false;
  }

  core::Ledger ledger_;
  EntrySize size_;
  std::string key_;
  bool is_in_list_ = false;
  bool is_parsed_ = false;
};

// One entry by itself.
Json parse_entry(const std::string& text) {
  EntrySize size;
  return Json::parse(text, [&size](int, Json::parse_event_t, const Json&) {
    size.count();
    return true;
  });
}

}  // namespace

core::Ledger read_loops_json(const std::filesystem::path& path) {
  const std::string text = core::read_file(path);
  Document document;
  try {
    return std::move(document).read(text);
  } catch (const Json::exception& error) {
    throw core::InputError(fmt::format("{}: {}expected what `samewhere run` writes, but {}",
                                       path.string(), document.where(), error.what()));
  } catch (const core::InputError& error) {
    throw core::InputError(fmt::format("{}: {}{}", path.string(), document.where(), error.what()));
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
      const Json json = parse_entry(row);
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
