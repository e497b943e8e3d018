#include <array>
#include <map>
#include <string>
#include <string_view>

#include <fmt/format.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/twin/building/presets_each.hpp>
#include <samewhere/twin/building/presets_route.hpp>

namespace samewhere::twin {
namespace {

struct Builder {
  std::string_view preset;
  World (*build)(const Spec&);
};

constexpr std::array<Builder, 8> kBuilders = {{{"office-loop", office_loop},
                                               {"twin-corridors", twin_corridors},
                                               {"hotel", hotel},
                                               {"no-return", no_return},
                                               {"warehouse", warehouse},
                                               {"mirror", mirror},
                                               {"long-haul", long_haul},
                                               {"second-visit", second_visit}}};

// A name that several things bear does not determine the place.
void keep_unique_names(Building& building) {
  std::map<std::string, int> num_with_name;
  for (const auto& object : building.objects) ++num_with_name[object.name];
  for (auto& object : building.objects) {
    object.is_unique = object.is_unique && num_with_name[object.name] == 1;
  }
}

}  // namespace

World build_world(const Spec& spec) {
  for (const auto& [preset, build] : kBuilders) {
    if (spec.preset != preset) continue;
    World world = build(spec);
    for (auto& building : world.visits) keep_unique_names(building);
    world.paths_of_people = paths_along(world.route);
    world.route.speed_m_s *= spec.speed;
    return world;
  }
  throw core::InputError(fmt::format("unknown preset {}", spec.preset));
}

}  // namespace samewhere::twin
