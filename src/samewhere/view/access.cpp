#include <cctype>
#include <utility>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/view/access.hpp>

namespace samewhere::view {
namespace {

// An address of the machine, as digits: a site has no such name.
bool is_number_of(std::string_view host, int port) {
  const std::string tail = fmt::format(":{}", port);
  if (!host.ends_with(tail)) return false;
  host.remove_suffix(tail.size());
  const bool is_bracketed = host.size() > 2 && host.front() == '[' && host.back() == ']';
  constexpr std::string_view kDigits = "0123456789.";
  constexpr std::string_view kHexDigits = "0123456789abcdef:.[]";
  return !host.empty() &&
         host.find_first_not_of(is_bracketed ? kHexDigits : kDigits) == std::string_view::npos;
}

}  // namespace

Access::Access(Place place, std::string token)
    : place_(std::move(place)), token_(std::move(token)) {
  core::require(is_on_this_machine(place_) || !token_.empty(),
                "a viewer that other machines reach has a token");
}

bool Access::is_own_host(std::string_view host) const {
  if (host == host_of(place_)) return true;
  if (is_on_this_machine(place_)) return host == fmt::format("localhost:{}", place_.port);
  const bool is_everywhere = place_.address == "0.0.0.0" || place_.address == "::";
  return is_everywhere && is_number_of(host, place_.port);
}

std::optional<std::string> Access::refusal(const Caller& caller) const {
  if (!is_own_host(caller.host)) return "this address is not served; expected " + host_of(place_);
  if (!caller.origin.empty() && caller.origin != "http://" + caller.host)
    return "requests of other sites are refused";
  const bool is_own_site = caller.fetch_site.empty() || caller.fetch_site == "same-origin" ||
                           caller.fetch_site == "none" || caller.is_page;
  if (!is_own_site) return "requests of other sites are refused";
  if (!token_.empty() && !is_same_secret(caller.token, token_))
    return "the token is missing or wrong; expected the address that samewhere printed";
  return std::nullopt;
}

std::string token_error(const std::string& token) {
  constexpr std::size_t kMinToken = 8;
  for (const char c : token) {
    const bool is_plain =
        std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_' || c == '.';
    if (!is_plain) return "expected letters, digits, '-', '_' and '.'";
  }
  return token.size() < kMinToken ? "expected at least 8 characters" : "";
}

bool is_same_secret(std::string_view given, std::string_view expected) {
  unsigned difference = given.size() == expected.size() ? 0U : 1U;
  for (std::size_t i = 0; i < given.size(); ++i) {
    const char other = expected.empty() ? '\0' : expected[i % expected.size()];
    difference |= static_cast<unsigned>(static_cast<unsigned char>(given[i]) ^
                                        static_cast<unsigned char>(other));
  }
  return difference == 0U;
}

}  // namespace samewhere::view
