#include <set>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <samewhere/train/place_pairs.hpp>

namespace samewhere::train {
namespace {

using core::PlaceTruth;

// 20 views of a list, then 4 frames of a walk: 0 and 2 show one place, 1 is near both, 3 is
// another.
ImageSet list_and_walk() {
  constexpr auto kOther = PlaceTruth::kDifferent;
  constexpr auto kSame = PlaceTruth::kSame;
  constexpr auto kNear = PlaceTruth::kNear;
  ImageSet images{.sources = {{"list", 20}, {"walk", 4}}};
  images.views.resize(24);
  images.sources[1].places = {4,
                              {kSame, kNear, kSame, kOther,  //
                               kNear, kSame, kNear, kOther,  //
                               kSame, kNear, kSame, kOther,  //
                               kOther, kOther, kOther, kSame}};
  return images;
}

Split all_but(const ImageSet& images, const std::set<int>& held_back) {
  Split split;
  for (int i = 0; i < static_cast<int>(images.views.size()); ++i) {
    (held_back.contains(i) ? split.validation : split.training).push_back(i);
  }
  return split;
}

std::set<int> partners_of(const PlacePairs& pairs, int view) {
  std::set<int> partners;
  core::Random random(3);
  for (int i = 0; i < 100; ++i) partners.insert(pairs.partner(view, random));
  return partners;
}

TEST(PlacePairs, APartnerShowsTheSamePlace) {
  const ImageSet images = list_and_walk();
  const PlacePairs pairs(images, all_but(images, {}), true);
  EXPECT_THAT(partners_of(pairs, 7), testing::ElementsAre(7));
  EXPECT_THAT(partners_of(pairs, 20), testing::ElementsAre(20, 22));
  EXPECT_THAT(partners_of(pairs, 21), testing::ElementsAre(21));
  const PlacePairs alone(images, all_but(images, {}), false);
  EXPECT_THAT(partners_of(alone, 20), testing::ElementsAre(20));
}

TEST(PlacePairs, APartnerIsNeverHeldBack) {
  const ImageSet images = list_and_walk();
  const PlacePairs pairs(images, all_but(images, {22}), true);
  EXPECT_THAT(partners_of(pairs, 20), testing::ElementsAre(20));
  EXPECT_THAT(partners_of(pairs, 22), testing::ElementsAre(22));
}

TEST(PlacePairs, OnlySurelyOtherPlacesAreSetAgainstEachOther) {
  const ImageSet images = list_and_walk();
  const PlacePairs pairs(images, all_but(images, {}), true);
  EXPECT_FALSE(pairs.are_other_places(0, 8)) << "neighbours of a list may overlap";
  EXPECT_TRUE(pairs.are_other_places(0, 9));
  EXPECT_TRUE(pairs.are_other_places(19, 20)) << "two sources";
  EXPECT_FALSE(pairs.are_other_places(20, 21)) << "near is neither same nor other";
  EXPECT_TRUE(pairs.are_other_places(20, 23)) << "truth counts, not the order";
  const std::vector<int> views = {0, 20, 23};
  const std::vector<int> partners = {0, 22, 21};
  EXPECT_THAT(pairs.other_places(views, partners), testing::ElementsAre(0, 1, 1, 1, 0, 0, 1, 0, 0))
      << "the partner of view 23 is near those of pair 1";
}

}  // namespace
}  // namespace samewhere::train
