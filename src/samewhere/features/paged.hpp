#pragma once

#include <memory>

#include <samewhere/core/paged_memory.hpp>
#include <samewhere/features/features.hpp>

namespace samewhere::features {

// The same features in memory that can be left; as they are if there is none.
std::shared_ptr<const Features> paged(std::shared_ptr<const Features> features,
                                      core::PagedMemory& memory);

// They come back where they are read. Nothing happens to features that are not paged.
void leave_memory(const Features& features);

}  // namespace samewhere::features
