#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

namespace samewhere::report {

// Text as it may stand in HTML, between tags or in a quoted attribute.
std::string escaped(std::string_view text);

// The template with each placeholder, in the order of the template, replaced by a text. What is in
// the texts is not searched.
std::string filled(
    std::string_view page,
    std::initializer_list<std::pair<std::string_view, std::string>> text_of_placeholder);

// JSON as it may stand in a script element: `<` is escaped, and what is no UTF-8 replaced.
std::string for_script(const nlohmann::ordered_json& json);

}  // namespace samewhere::report
