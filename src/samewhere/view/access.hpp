#pragma once

#include <optional>
#include <string>
#include <string_view>

#include <samewhere/view/place.hpp>

namespace samewhere::view {

// What a request says of where it comes from.
struct Caller {
  std::string host;        // header Host
  std::string origin;      // header Origin; empty: absent
  std::string fetch_site;  // header Sec-Fetch-Site; empty: absent
  std::string token;       // parameter `token`
  bool is_page = false;    // a page, which a link of another site may open
};

// Which requests are answered. A browser on this machine carries requests of any site that it
// shows, so that the address alone protects nothing: the name that was asked for (against DNS
// rebinding) and the site that asks are checked, too.
class Access {
 public:
  // Empty token: none is asked for. A place that other machines reach has one.
  Access(Place place, std::string token);

  // Why the request is refused, for a person; nothing: it is not.
  std::optional<std::string> refusal(const Caller& caller) const;

 private:
  bool is_own_host(std::string_view host) const;

  Place place_;
  std::string token_;
};

// Why this is no token that a user may choose: it stands in addresses without escapes. Empty: it is
// one.
std::string token_error(const std::string& token);

// In a time that does not tell how much of them is equal.
bool is_same_secret(std::string_view given, std::string_view expected);

}  // namespace samewhere::view
