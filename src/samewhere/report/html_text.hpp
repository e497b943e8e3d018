#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace samewhere::report {

// Text as it may stand in HTML, between tags or in a quoted attribute.
std::string escaped(std::string_view text);

// The template with each placeholder, in the order of the template, replaced by a text. What is in
// the texts is not searched.
std::string filled(
    std::string_view page,
    std::initializer_list<std::pair<std::string_view, std::string>> text_of_placeholder);

}  // namespace samewhere::report
