#include <utility>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/input/left_out.hpp>

namespace samewhere::input {

void LeftOut::add(std::string why) {
  if (count_++ == 0) first_ = std::move(why);
}

void LeftOut::warn(std::size_t num_all, const char* nouns) const {
  if (count_ == 0) return;
  spdlog::warn("{} of {} {} are left out; the first: {}", count_, num_all, nouns, first_);
}

void LeftOut::refuse_most(std::size_t num_all, const char* nouns) const {
  if (2 * count_ <= num_all) return;
  if (count_ == 1) throw core::InputError(first_);
  throw core::InputError(
      fmt::format("{}; so it is with {} of {} {}", first_, count_, num_all, nouns));
}

}  // namespace samewhere::input
