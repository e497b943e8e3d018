#pragma once

#include <samewhere/twin/building/presets.hpp>

namespace samewhere::twin {

// One for each preset, whatever the spec calls itself. What they are for is told by list_presets(),
// how they are laid out where they are defined.
World office_loop(const Spec& spec);
World twin_corridors(const Spec& spec);
World hotel(const Spec& spec);
World no_return(const Spec& spec);
World warehouse(const Spec& spec);
World mirror(const Spec& spec);
World long_haul(const Spec& spec);
World second_visit(const Spec& spec);

}  // namespace samewhere::twin
