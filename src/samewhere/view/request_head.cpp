#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <set>

#include <samewhere/view/request_head.hpp>

namespace samewhere::view {
namespace {

constexpr int kBadRequest = 400;
constexpr int kTooLarge = 413;
constexpr int kNotImplemented = 501;

constexpr std::array<std::string_view, 5> kReadHeaders = {"host", "origin", "sec-fetch-site",
                                                          "content-type", "content-length"};

std::string lower(std::string_view text) {
  std::string result(text);
  std::transform(result.begin(), result.end(), result.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return result;
}

bool is_plain(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](char c) { return c >= ' ' && c != '\x7f'; });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

// 0: it may come.
int status_of_length(std::string_view value) {
  std::size_t length = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), length);
  if (error == std::errc::result_out_of_range) return kTooLarge;
  if (error != std::errc() || end != value.data() + value.size()) return kBadRequest;
  return length > kMaxBody_bytes ? kTooLarge : 0;
}

// 0: the method and the version are known.
int status_of_request_line(std::string_view line) {
  if (!is_plain(line) || !line.ends_with(" HTTP/1.1")) return kBadRequest;
  return line.starts_with("GET /") || line.starts_with("POST /") ? 0 : kNotImplemented;
}

class HeadFilter {
 public:
  // 0: goes on.
  int add(std::string_view line) {
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos || !is_plain(line)) return kBadRequest;
    const std::string name = lower(line.substr(0, colon));
    if (name == "transfer-encoding") return kNotImplemented;
    if (std::find(kReadHeaders.begin(), kReadHeaders.end(), name) == kReadHeaders.end()) return 0;
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (!names_.insert(name).second) return kBadRequest;
    text_.append(name).append(": ").append(value).append("\r\n");
    return name == "content-length" ? status_of_length(value) : 0;
  }
  const std::string& text() const { return text_; }

 private:
  std::set<std::string> names_;
  std::string text_;
};

}  // namespace

RequestHead checked_head(std::string_view head) {
  HeadFilter filter;
  std::string request_line;
  while (true) {
    const std::size_t end = head.find("\r\n");
    if (end == std::string_view::npos) return {"", kBadRequest};
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(end + 2);
    if (request_line.empty()) {
      request_line = std::string(line) + "\r\n";
      if (const int status = status_of_request_line(line)) return {"", status};
    } else if (line.empty()) {
      return {request_line + filter.text() + "\r\n", 0};
    } else if (const int status = filter.add(line)) {
      return {"", status};
    }
  }
}

}  // namespace samewhere::view
