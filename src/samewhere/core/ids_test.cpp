#include <sstream>
#include <type_traits>

#include <gtest/gtest.h>

#include <samewhere/core/errors.hpp>
#include <samewhere/core/ids.hpp>

namespace samewhere::core {
namespace {

template <class Tag>
std::string printed(const Id<Tag>& id) {
  std::ostringstream out;
  out << id;
  return out.str();
}

TEST(Ids, ADefaultIdIsInvalid) {
  EXPECT_FALSE(FrameId().is_valid());
  EXPECT_TRUE(FrameId(0).is_valid());
  EXPECT_EQ(printed(FrameId()), "none");
}

TEST(Ids, TheSessionSitsInTheHighBitsAndTheIndexBelow) {
  const KeyframeId id(812, 3);
  EXPECT_EQ(id.value(), (std::uint64_t{3} << 48) + 812);
  EXPECT_EQ(id.index(), 812U);
  EXPECT_EQ(id.session(), 3);
  EXPECT_EQ(KeyframeId::from_value(id.value()), id);
  EXPECT_EQ(printed(id), "3:812");
  EXPECT_EQ(printed(KeyframeId(812)), "812");
}

TEST(Ids, TheSameIndexInTwoSessionsIsTwoIds) {
  EXPECT_NE(FrameId(5, 1), FrameId(5, 2));
  EXPECT_LT(FrameId(FrameId::kMaxIndex, 1), FrameId(0, 2)) << "ids sort by session, then index";
}

TEST(Ids, TheLargestIdIsNotMistakenForNone) {
  EXPECT_TRUE(FrameId(FrameId::kMaxIndex, 0xffff).is_valid());
}

TEST(Ids, AnIndexThatWouldSpillIntoTheSessionIsRefused) {
  EXPECT_THROW(FrameId(std::uint64_t{1} << 48), ContractError);
  EXPECT_THROW(FrameId(static_cast<std::uint64_t>(-1)), ContractError);
}

TEST(Ids, IdsOfDifferentKindsDoNotMix) {
  static_assert(!std::is_convertible_v<FrameId, KeyframeId>);
  static_assert(!std::is_constructible_v<FrameId, KeyframeId>);
  static_assert(!std::is_convertible_v<int, FrameId>);
}

}  // namespace
}  // namespace samewhere::core
