#include <samewhere/core/errors.hpp>
#include <samewhere/report/html_text.hpp>

namespace samewhere::report {

std::string escaped(std::string_view text) {
  std::string html;
  html.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string filled(
    std::string_view page,
    std::initializer_list<std::pair<std::string_view, std::string>> text_of_placeholder) {
  std::string html;
  for (const auto& [placeholder, text] : text_of_placeholder) {
    const std::size_t at = page.find(placeholder);
    core::require(at != std::string_view::npos, "the page has a place for each of its parts");
    html.append(page.substr(0, at)).append(text);
    page.remove_prefix(at + placeholder.size());
  }
  return html.append(page);
}

}  // namespace samewhere::report
