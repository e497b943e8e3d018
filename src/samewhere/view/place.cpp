#include <array>
#include <charconv>
#include <string_view>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <sys/random.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/printable.hpp>
#include <samewhere/view/place.hpp>

namespace samewhere::view {
namespace {

bool is_version_6(const std::string& address) {
  in6_addr parsed{};
  return ::inet_pton(AF_INET6, address.c_str(), &parsed) == 1;
}

bool is_address(const std::string& address) {
  in_addr parsed{};
  return ::inet_pton(AF_INET, address.c_str(), &parsed) == 1 || is_version_6(address);
}

// 0: it is none.
int port_of(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool is_whole = error == std::errc() && end == text.data() + text.size();
  return is_whole && port > 0 && port < 65536 ? port : 0;
}

}  // namespace

Place parse_place(const std::string& text, const std::string& option) {
  if (text == "any") return {};
  Place place{.is_port_wanted = true};
  const std::size_t colon = text.rfind(':');
  if (colon != std::string::npos) {
    place.address = text.substr(0, colon);
    if (place.address.size() > 2 && place.address.front() == '[' && place.address.back() == ']')
      place.address = place.address.substr(1, place.address.size() - 2);
  }
  place.port = port_of(std::string_view(text).substr(colon == std::string::npos ? 0 : colon + 1));
  if (place.port > 0 && is_address(place.address)) return place;
  throw core::InputError(fmt::format(
      "{} = {}: expected PORT or ADDRESS:PORT with an IP address and a port of 1 to 65535", option,
      core::printable_line(text, core::kMaxMessage)));
}

bool is_on_this_machine(const Place& place) {
  return place.address.starts_with("127.") || place.address == "::1";
}

std::string host_of(const Place& place) {
  return is_version_6(place.address) ? fmt::format("[{}]:{}", place.address, place.port)
                                     : fmt::format("{}:{}", place.address, place.port);
}

std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw core::InputError("the system gives no random numbers for a token; expected --token");
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace samewhere::view
