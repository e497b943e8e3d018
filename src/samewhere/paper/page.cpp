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
tr.published { color: #767676; }
td.words { white-space: normal; text-align: left; }
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
closure detection algorithm” (PLoS ONE, doi 10.1371/journal.pone.0312358) on the sequences named in the rows. Grey: what the
paper reports of its own sequences, not measured here.</p>
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

std::string row_html(const PaperTable::Row& row) {
  std::string html = row.is_published ? "<tr class=\"published\">" : "<tr>";
  for (const std::string& cell : row.cells) html += fmt::format("<td>{}</td>", escaped(cell));
  return html + "</tr>\n";
}

std::string table_html(const PaperTable& table) {
  std::string html = fmt::format("<h2>Table {}: {}</h2>\n<div class=\"wide\"><table><thead><tr>",
                                 table.number, escaped(table.title));
  for (const std::string& cell : table.header) html += fmt::format("<th>{}</th>", escaped(cell));
  html += "</tr></thead><tbody>\n";
  for (const PaperTable::Row& row : table.rows) html += row_html(row);
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
