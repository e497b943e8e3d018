#pragma once

#include <span>
#include <string>

namespace samewhere::train {

// Throws InputError if a source to validate with is learnt from, too: the same file or folder, or a
// rendered building of the same preset and seed. `option` names the others.
void require_other_places(std::span<const std::string> sources,
                          std::span<const std::string> validate, const std::string& option);

}  // namespace samewhere::train
