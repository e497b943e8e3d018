#include <algorithm>

#include <samewhere/core/errors.hpp>
#include <samewhere/node/topics.hpp>

namespace samewhere::node {
namespace {

constexpr std::string_view kCompressed = "/compressed";

std::string without_slashes_around(std::string_view name) {
  const std::size_t begin = name.find_first_not_of('/');
  if (begin == std::string_view::npos) return "";
  return std::string(name.substr(begin, name.find_last_not_of('/') - begin + 1));
}

}  // namespace

TopicNames::TopicNames(const std::string& node_namespace,
                       const std::vector<std::string>& remappings)
    : namespace_(without_slashes_around(node_namespace)) {
  for (const std::string& text : remappings) {
    const std::size_t sign = text.find(":=");
    if (sign == std::string::npos || sign == 0 || sign + 2 == text.size())
      throw core::InputError("remapping '" + text + "': expected FROM:=TO");
    remappings_.push_back({resolved(text.substr(0, sign)), resolved(text.substr(sign + 2))});
  }
}

std::string TopicNames::resolved(std::string_view name) const {
  if (name.starts_with('/') || namespace_.empty()) return "/" + without_slashes_around(name);
  return "/" + namespace_ + "/" + without_slashes_around(name);
}

std::string TopicNames::name_of(std::string_view topic) const {
  const std::string name = resolved(topic);
  const auto found =
      std::find_if(remappings_.begin(), remappings_.end(),
                   [&](const Remapping& remapping) { return remapping.from == name; });
  if (found != remappings_.end()) return found->to;
  if (!topic.ends_with(kCompressed)) return name;
  return name_of(topic.substr(0, topic.size() - kCompressed.size())) + std::string(kCompressed);
}

}  // namespace samewhere::node
