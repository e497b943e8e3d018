#pragma once

#include <tl/expected.hpp>

namespace samewhere {

// For functions with two outcomes: a value, or the reason why there is none.
template <class T, class E>
using Result = tl::expected<T, E>;

template <class E>
tl::unexpected<std::decay_t<E>> refuse(E&& reason) {
  return tl::unexpected<std::decay_t<E>>(std::forward<E>(reason));
}

}  // namespace samewhere
