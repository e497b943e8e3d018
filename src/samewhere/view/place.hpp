#pragma once

#include <string>

namespace samewhere::view {

// Where a viewer is served.
struct Place {
  std::string address = "127.0.0.1";
  int port = 8080;
  bool is_port_wanted = false;  // false: any free port will do where this one is taken
};

// From "PORT", "ADDRESS:PORT", "[ADDRESS]:PORT" or, for the default, "any". The address is one of
// IP version 4 or 6. Throws InputError naming the option.
Place parse_place(const std::string& text, const std::string& option);

// Whether only programs on this machine reach it.
bool is_on_this_machine(const Place& place);

// "127.0.0.1:8080", "[::1]:8080".
std::string host_of(const Place& place);

// 128 random bits as text, from the system.
std::string random_token();

}  // namespace samewhere::view
