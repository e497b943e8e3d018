#pragma once

#include <string>

#include <samewhere/scene/map_file.hpp>
#include <samewhere/scene/map_version.hpp>

namespace samewhere::scene {

// Whether all that the map's parts say of each other is so: ids are positions, what they name is
// there, slots and observations agree, and no chain of merges or of parents leads in a ring. The
// numbers of each part are checked before (map_values.hpp). Throws InputError beginning with
// `where` ("m.sw") that names the first part that is wrong.
void check_map(const MapVersion& map, const std::string& where);

// The same of what belongs to a map beside it.
void check_extras(const StoredMap& stored, const std::string& where);

}  // namespace samewhere::scene
