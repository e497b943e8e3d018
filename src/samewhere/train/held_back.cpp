#include <algorithm>
#include <filesystem>
#include <system_error>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/train/held_back.hpp>
#include <samewhere/twin/building/spec.hpp>

namespace samewhere::train {
namespace {

bool show_the_same(const std::string& a, const std::string& b) {
  if (twin::is_twin_spec(a) != twin::is_twin_spec(b)) return false;
  if (twin::is_twin_spec(a)) {
    const twin::Spec first = twin::parse_spec(a);
    const twin::Spec second = twin::parse_spec(b);
    return first.preset == second.preset && first.seed == second.seed;
  }
  std::error_code ignored;  // what is not there is found when it is read
  return a == b || std::filesystem::equivalent(a, b, ignored);
}

}  // namespace

void require_other_places(std::span<const std::string> sources,
                          std::span<const std::string> validate, const std::string& option) {
  for (const std::string& held_back : validate) {
    const auto same = std::find_if(sources.begin(), sources.end(), [&](const std::string& source) {
      return show_the_same(source, held_back);
    });
    if (same == sources.end()) continue;
    throw core::InputError(fmt::format(
        "--validate {}: is learnt from, too ({} {}), expected places not seen in training",
        held_back, option, *same));
  }
}

}  // namespace samewhere::train
