#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <samewhere/core/errors.hpp>
#include <samewhere/report/compare.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/run/override.hpp>
#include <samewhere/view/finished_run.hpp>
#include <samewhere/view/finished_view.hpp>

namespace samewhere::view {
namespace {

bool is_map_file(const std::filesystem::path& path) {
  std::error_code unknown;  // what cannot be looked at is told by the one that opens it
  return path.extension() == ".sw" && !std::filesystem::is_directory(path, unknown);
}

std::string own_path(std::size_t number) { return fmt::format("/run/{}", number); }
std::string override_path(std::size_t number) { return fmt::format("/override/{}", number); }

std::string token_of(const Place& place, const std::string& token) {
  return token.empty() && !is_on_this_machine(place) ? random_token() : token;
}

}  // namespace

FinishedView::FinishedView(const std::vector<std::filesystem::path>& paths, const Place& place,
                           const std::string& token) {
  for (const std::filesystem::path& path : paths) {
    shown_.push_back(std::make_unique<Shown>());
    shown_.back()->path = path;
    read(shown_.size() - 1);
  }
  const std::string asked = token_of(place, token);
  server_ = std::make_unique<Server>(place, asked, routes(asked));
}

void FinishedView::read(std::size_t number) {
  Shown& shown = *shown_[number];
  const bool is_map = is_map_file(shown.path);
  const report::PageBlocks blocks = is_map ? page_of_map(shown.path) : page_of_run(shown.path);
  shown.title = blocks.title;
  nlohmann::json live = {{"mode", "finished"}};
  if (!is_map && may_override(shown.path)) live["override"] = override_path(number);
  shown.page.set(std::make_shared<const std::string>(report::served_html(blocks, live.dump())));
}

Routes FinishedView::routes(const std::string& token) {
  Routes routes;
  routes.streams["/events"] = [] { return [] { return std::string(); }; };
  for (std::size_t i = 0; i < shown_.size(); ++i) add_routes(i, routes);
  if (shown_.size() == 1) {
    routes.pages["/"] = routes.pages.at(own_path(0));
    return routes;
  }
  const std::string asked = token.empty() ? "" : "?token=" + token;
  if (are_all_runs())
    routes.pages["/compare"] = [this] { return std::make_shared<const std::string>(compared()); };
  std::vector<Beside> pages;
  for (std::size_t i = 0; i < shown_.size(); ++i)
    pages.push_back({shown_[i]->title + " · " + shown_[i]->path.string(), own_path(i) + asked});
  routes.pages["/"] = [page = std::make_shared<const std::string>(side_by_side_html(
                           pages, are_all_runs() ? "/compare" + asked : ""))] { return page; };
  return routes;
}

bool FinishedView::are_all_runs() const {
  return std::none_of(shown_.begin(), shown_.end(),
                      [](const auto& shown) { return is_map_file(shown->path); });
}

// With the verdicts of now.
std::string FinishedView::compared() const {
  std::vector<report::ComparedRun> runs;
  for (const auto& shown : shown_)
    runs.push_back(
        report::read_report_html(*shown->page.get(), shown->path.string(), shown->path.string()));
  return report::compare_html(runs);
}

void FinishedView::add_routes(std::size_t number, Routes& routes) {
  routes.pages[own_path(number)] = [this, number] { return shown_[number]->page.get(); };
  if (!is_map_file(shown_[number]->path))
    routes.actions[override_path(number)] = [this, number](const std::string& body) {
      return override_verdict(number, body);
    };
}

Answer FinishedView::override_verdict(std::size_t number, const std::string& body) {
  const auto wish = nlohmann::json::parse(body, nullptr, false);
  const bool is_whole = wish.is_object() && wish.contains("candidate") &&
                        wish["candidate"].is_number_unsigned() && wish.contains("as") &&
                        (wish["as"] == "reject" || wish["as"] == "force");
  if (!is_whole) throw core::InputError(R"(expected {"candidate": 12, "as": "reject" or "force"})");
  const auto as = wish["as"] == "reject" ? run::Override::kReject : run::Override::kForce;
  return shown_[number]->overriding.with([&](int) {
    const run::OverriddenRun changed =
        run::override_run(shown_[number]->path, wish["candidate"].get<std::size_t>(), as, {});
    read(number);
    return Answer{200,
                  fmt::format(R"({{"num_loops":{},"num_loops_before":{},"farthest_m":{:.4f}}})",
                              changed.num_loops, changed.num_loops_before, changed.farthest_m)};
  });
}

std::string side_by_side_html(const std::vector<Beside>& pages, const std::string& compared) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n"
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data:; "
      "frame-src 'self'; style-src 'unsafe-inline'\">\n<link rel=\"icon\" href=\"data:,\">\n"
      "<title>samewhere: runs side by side</title>\n<style>\n"
      "body { margin: 0; height: 100vh; display: grid; grid-auto-flow: column; "
      "grid-auto-columns: minmax(480px, 1fr); gap: 6px; overflow-x: auto; background: #80868b; }\n"
      "section { display: flex; flex-direction: column; min-width: 0; }\n"
      "h2 { margin: 0; padding: 4px 10px; font: 600 13px system-ui, sans-serif; background: #fff; "
      "overflow-wrap: anywhere; }\n"
      "a { position: fixed; right: 12px; bottom: 12px; padding: 4px 12px; border-radius: 7px; "
      "background: #0b5cad; color: #fff; font: 13px system-ui, sans-serif; }\n"
      "iframe { flex: 1; border: 0; background: #fff; }\n</style></head>\n<body>\n";
  for (const Beside& page : pages)
    html += fmt::format("<section><h2>{}</h2><iframe src=\"{}\" title=\"{}\"></iframe></section>\n",
                        report::escaped(page.title), report::escaped(page.path),
                        report::escaped(page.title));
  if (!compared.empty())
    html += fmt::format("<a href=\"{}\">all on one page</a>\n", report::escaped(compared));
  return html + "</body></html>\n";
}

}  // namespace samewhere::view
