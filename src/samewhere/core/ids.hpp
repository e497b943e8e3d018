#pragma once

#include <compare>
#include <cstdint>
#include <ostream>

#include <samewhere/core/errors.hpp>

namespace samewhere::core {

// A 64-bit id of one kind of object; ids of different kinds do not mix. The session is in the high
// 16 bits, so that maps of different sessions merge without renumbering. A default id is invalid.
template <class Tag>
class Id {
 public:
  static constexpr int kIndexBits = 48;
  static constexpr std::uint64_t kMaxIndex = (std::uint64_t{1} << kIndexBits) - 2;

  constexpr Id() = default;
  // A larger index (a negative number that was cast) would spill into the session: ContractError.
  constexpr explicit Id(std::uint64_t index, std::uint16_t session = 0)
      : value_((std::uint64_t{session} << kIndexBits) | index) {
    if (index > kMaxIndex) require(false, "the index of an Id fits into 48 bits");
  }

  static constexpr Id from_value(std::uint64_t value) {
    Id id;
    id.value_ = value;
    return id;
  }

  constexpr std::uint64_t value() const { return value_; }
  constexpr std::uint64_t index() const { return value_ & ((std::uint64_t{1} << kIndexBits) - 1); }
  constexpr std::uint16_t session() const {
    return static_cast<std::uint16_t>(value_ >> kIndexBits);
  }
  constexpr bool is_valid() const { return value_ != kInvalid; }
  constexpr auto operator<=>(const Id&) const = default;

 private:
  static constexpr std::uint64_t kInvalid = ~std::uint64_t{0};
  std::uint64_t value_ = kInvalid;
};

template <class Tag>
std::ostream& operator<<(std::ostream& out, const Id<Tag>& id) {
  if (!id.is_valid()) return out << "none";
  if (id.session() != 0) out << id.session() << ':';
  return out << id.index();
}

using FrameId = Id<struct FrameTag>;          // index = 0-based position in the source
using KeyframeId = Id<struct KeyframeTag>;    // index = 0-based position among the keyframes
using LandmarkId = Id<struct LandmarkTag>;    //
using CandidateId = Id<struct CandidateTag>;  // index = 0-based position in the ledger

}  // namespace samewhere::core
