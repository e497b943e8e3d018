#include <algorithm>
#include <charconv>
#include <optional>

#include <fmt/format.h>

#include <samewhere/paper/page.hpp>
#include <samewhere/report/html_text.hpp>
#include <samewhere/report/jpeg.hpp>

namespace samewhere::paper {
namespace {

using report::escaped;

constexpr std::string_view kPage = R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; img-src data:; style-src 'unsafe-inline'">
<link rel="icon" href="data:,">
<title>The published method and others</title>
<style>
body { font: 15px/1.5 system-ui, sans-serif; max-width: 80rem; margin: 2rem auto; padding: 0 1rem; }
h2 { margin-top: 2.5rem; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; }
th, td { padding: .2rem .7rem; text-align: right; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; }
thead th { border-bottom: 2px solid currentColor; }
.published { color: #767676; font-weight: normal; }
td.words { white-space: normal; text-align: left; }
th.published { white-space: normal; }
p.note, figcaption { color: #767676; }
figure { margin: 2rem 0; }
img { max-width: 100%; background: #fff; }
code { overflow-wrap: anywhere; }
@media print { h2 { break-after: avoid; } figure, tr { break-inside: avoid; } }
</style>
</head>
<body>
<h1>The published method and others</h1>
<p>Tables and figures of “Accurate localization of indoor high similarity scenes using visual SLAM combined with loop
closure detection algorithm” (PLoS ONE, doi 10.1371/journal.pone.0312358) on other sequences. Grey: what the
paper reports of its own, not measured here. Bold: the best of a sequence.</p>
<p>Made by <code>{{command}}</code></p>
{{tables}}
{{figures}}
<h2>What ran</h2>
<div class="wide"><table><thead><tr><th>method</th><th>name</th><th>what ran</th></tr></thead><tbody>
{{methods}}
</tbody></table></div>
{{missing}}
</body>
</html>
)";

// What a cell begins with; nothing if that is no figure.
std::optional<double> figure_of(const std::string& cell) {
  double figure = 0.0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), figure);
  return error == std::errc{} ? std::optional(figure) : std::nullopt;
}

constexpr const char* kPublishedClass = " class=\"published\"";

// The largest figure of a column; nothing if it has none.
std::optional<double> best_of(const PaperTable& table, std::size_t column) {
  std::optional<double> best;
  for (const PaperTable::Row& row : table.rows) {
    if (const auto figure = figure_of(row.cells[column]))
      best = std::max(best.value_or(*figure), *figure);
  }
  return best;
}

// A cell of each column, in words or in figures.
class ColumnsHtml {
 public:
  explicit ColumnsHtml(const PaperTable& table)
      : first_published_(table.header.size() -
                         static_cast<std::size_t>(table.num_published_columns)) {
    for (std::size_t column = 0; column < table.header.size(); ++column) {
      const bool is_compared = table.is_more_better && column > 0 && column < first_published_;
      best_.push_back(is_compared ? best_of(table, column) : std::nullopt);
    }
  }

  std::string cell(std::size_t column, const std::string& text, const char* tag) const {
    const bool is_best = best_[column] && figure_of(text) == best_[column];
    return fmt::format("<{0}{1}>{2}{3}{4}</{0}>", tag,
                       column < first_published_ ? "" : kPublishedClass, is_best ? "<b>" : "",
                       escaped(text), is_best ? "</b>" : "");
  }

 private:
  std::size_t first_published_;
  std::vector<std::optional<double>> best_;
};

std::string table_html(const PaperTable& table) {
  const ColumnsHtml columns(table);
  std::string html = fmt::format("<h2>Table {}: {}</h2>\n<div class=\"wide\"><table><thead><tr>",
                                 table.number, escaped(table.title));
  for (std::size_t column = 0; column < table.header.size(); ++column)
    html += columns.cell(column, table.header[column], "th");
  html += "</tr></thead><tbody>\n";
  for (const PaperTable::Row& row : table.rows) {
    html += fmt::format("<tr{}>", row.is_published ? kPublishedClass : "");
    for (std::size_t column = 0; column < row.cells.size(); ++column)
      html += columns.cell(column, row.cells[column], "td");
    html += "</tr>\n";
  }
  return html +
         fmt::format("</tbody></table></div>\n<p class=\"note\">{}</p>\n", escaped(table.note));
}

std::string figure_html(const PageFigure& figure) {
  return fmt::format(
      "<figure><img alt=\"{0}\" "
      "src=\"data:image/svg+xml;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
      escaped(figure.title), report::base64(figure.svg));
}

std::string method_html(const ComparedMethod& method, std::string_view what) {
  return fmt::format("<tr><td>{}{}</td><td>{}</td><td class=\"words\">{}</td></tr>\n", what,
                     escaped(method.title), escaped(method.name), escaped(method.what_ran));
}

std::string methods_html(const Results& results) {
  std::string html;
  for (const ComparedMethod& method : results.methods) html += method_html(method, "");
  for (const ComparedMethod& method : results.configurations)
    html += method_html(method, "loop closing of SLAM: ");
  return html;
}

std::string missing_html(const Results& results) {
  if (results.missing.empty()) return "";
  std::string html = "<h2>What is missing</h2>\n<ul>\n";
  for (const MissingRow& row : results.missing) {
    html +=
        fmt::format("<li>{}{}{}: {}</li>\n", escaped(row.recording),
                    row.recording.empty() ? "" : ", ", escaped(row.method), escaped(row.reason));
  }
  return html + "</ul>\n";
}

}  // namespace

std::string page_html(const Results& results, const std::vector<PaperTable>& tables,
                      const std::vector<PageFigure>& figures, const std::string& command) {
  std::string all_tables;
  for (const PaperTable& table : tables) all_tables += table_html(table);
  std::string all_figures = figures.empty() ? "" : "<h2>Figures</h2>\n";
  for (const PageFigure& figure : figures) all_figures += figure_html(figure);
  return report::filled(kPage, {{"{{command}}", escaped(command)},
                                {"{{tables}}", all_tables},
                                {"{{figures}}", all_figures},
                                {"{{methods}}", methods_html(results)},
                                {"{{missing}}", missing_html(results)}});
}

}  // namespace samewhere::paper
