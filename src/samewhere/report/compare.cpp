#include <algorithm>
#include <cstdlib>
#include <map>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/page_data.hpp>
#include <samewhere/report/page_parts.hpp>
#include <samewhere/report/page_template.hpp>

namespace samewhere::report {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kSameFrames = 10;  // apart at most, of views that count as the same

// The text of a data block: the last of its name, as the scripts before it may mention it.
std::string block_of(std::string_view html, std::string_view id, const std::string& origin) {
  const std::string begin = fmt::format("<script type=\"application/json\" id=\"{}\">", id);
  const std::size_t at = html.rfind(begin);
  const std::size_t end = at == std::string_view::npos ? at : html.find("</script>", at);
  if (end == std::string_view::npos) {
    throw core::InputError(
        fmt::format("{}: has no block `{}`; expected the report.html of a run", origin, id));
  }
  return std::string(html.substr(at + begin.size(), end - at - begin.size()));
}

std::string verdict_of(const Json& candidate) {
  const std::string verdict = candidate.at("verdict");
  const std::string stage = candidate.at("stage");
  if (verdict == "LOOP") return "accepted";
  if (stage == "withdrawn") return stage;
  return (verdict == "AMBIGUOUS" ? "ambiguous: " : "rejected: ") + stage;
}

void read_run(const Json& run, ComparedRun& compared) {
  compared.source = run.at("source");
  for (const Json& figure : run.at("figures"))
    compared.figures.push_back({figure.at("name"), figure.at("value"), {}});
  for (const Json& candidate : run.at("candidates")) {
    if (candidate.contains("match_session")) continue;  // in a known map
    compared.candidates.push_back({candidate.at("query"), candidate.at("match"),
                                   verdict_of(candidate), candidate.value("is_false", false)});
  }
  std::stable_sort(compared.candidates.begin(), compared.candidates.end(),
                   [](const JudgedPair& a, const JudgedPair& b) { return a.query < b.query; });
}

// The verdict of the nearest candidate.
std::string verdict_on(const JudgedPair& pair, const std::vector<JudgedPair>& candidates) {
  const auto first = std::lower_bound(
      candidates.begin(), candidates.end(), pair.query - kSameFrames,
      [](const JudgedPair& candidate, int query) { return candidate.query < query; });
  const JudgedPair* nearest = nullptr;
  int least = 0;
  for (auto it = first; it != candidates.end() && it->query <= pair.query + kSameFrames; ++it) {
    const int of_match = std::abs(it->match - pair.match);
    const int apart = std::abs(it->query - pair.query) + of_match;
    if (of_match > kSameFrames || (nearest != nullptr && apart >= least)) continue;
    nearest = &*it;
    least = apart;
  }
  return nearest == nullptr ? "no candidate" : nearest->verdict;
}

std::vector<std::pair<std::string, int>> verdicts_on_false(
    const std::vector<JudgedPair>& accepted, const std::vector<JudgedPair>& candidates) {
  std::map<std::string, int> counts;
  for (const JudgedPair& pair : accepted)
    if (pair.is_false) ++counts[verdict_on(pair, candidates)];
  std::vector<std::pair<std::string, int>> sorted(counts.begin(), counts.end());
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const auto& a, const auto& b) { return a.second > b.second; });
  return sorted;
}

Json judged_json(const std::vector<ComparedRun>& runs) {
  Json array = Json::array();
  for (const JudgedElsewhere& judged : judged_elsewhere(runs)) {
    Json verdicts = Json::array();
    for (const auto& [verdict, count] : judged.verdicts)
      verdicts.push_back({{"verdict", verdict}, {"count", count}});
    array.push_back({{"accepted_by", judged.accepted_by},
                     {"judged_by", judged.judged_by},
                     {"verdicts", std::move(verdicts)}});
  }
  return array;
}

}  // namespace

ComparedRun read_report_html(std::string_view html, std::string name, const std::string& origin) {
  ComparedRun compared;
  compared.name = std::move(name);
  compared.run_json = block_of(html, "run", origin);
  compared.pictures_json = block_of(html, "pictures", origin);
  compared.durations_json = block_of(html, "durations", origin);
  try {
    const Json run = Json::parse(compared.run_json);
    const int version = run.at("version");
    if (version != kPageVersion) {
      throw core::InputError(fmt::format(
          "{}: version {} of the report page; expected {}: run it again with this program", origin,
          version, kPageVersion));
    }
    read_run(run, compared);
    for (const std::string* block : {&compared.pictures_json, &compared.durations_json})
      if (!Json::accept(*block)) throw core::InputError(origin + ": is damaged");
  } catch (const Json::exception& error) {
    throw core::InputError(fmt::format("{}: is damaged ({}); expected the report.html of a run",
                                       origin, error.what()));
  }
  return compared;
}

std::vector<JudgedElsewhere> judged_elsewhere(const std::vector<ComparedRun>& runs) {
  std::vector<JudgedElsewhere> all;
  for (std::size_t a = 0; a < runs.size(); ++a) {
    for (std::size_t b = 0; b < runs.size(); ++b) {
      if (a == b || runs[a].source != runs[b].source) continue;
      auto verdicts = verdicts_on_false(runs[a].candidates, runs[b].candidates);
      if (!verdicts.empty()) all.push_back({a, b, std::move(verdicts)});
    }
  }
  return all;
}

Table metrics_of(const std::vector<ComparedRun>& runs) {
  Table table;
  table.header = {"metric"};
  std::map<std::string, std::size_t> row_of_name;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    table.header.push_back(runs[i].name);
    for (const Figure& figure : runs[i].figures) {
      const auto [it, is_new] = row_of_name.try_emplace(figure.name, table.rows.size());
      if (is_new) {
        table.rows.emplace_back(runs.size() + 1, "-");
        table.rows.back().front() = figure.name;
      }
      table.rows[it->second][i + 1] = figure.value;
    }
  }
  return table;
}

std::string compare_html(const std::vector<ComparedRun>& runs) {
  std::string title;
  std::string json = "[";
  for (const ComparedRun& run : runs) {
    title += (title.empty() ? "" : " and ") + run.name;
    if (json.size() > 1) json += ',';
    json +=
        fmt::format(R"({{"name":{},"run":{},"pictures":{},"durations":{}}})",
                    json_for_script(run.name), run.run_json, run.pictures_json, run.durations_json);
  }
  return filled(compare_template(), {{"{{title}}", escaped(title)},
                                     {"{{runs}}", json + "]"},
                                     {"{{judged}}", json_for_script(judged_json(runs))},
                                     {"{{same_frames}}", fmt::format("{}", kSameFrames)}});
}

}  // namespace samewhere::report
