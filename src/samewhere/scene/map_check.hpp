#pragma once

#include <string>

#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Whether all that the map's parts say of each other is so: ids are positions, and what they name
// is there. Throws InputError beginning with `where` ("m.sw") that names the first part that is
// wrong.
void check_map(const MapVersion& map, const std::string& where);

}  // namespace samewhere::scene
